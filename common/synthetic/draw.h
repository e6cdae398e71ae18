// Random numbers as a pure function of a key: the same key gives the same numbers, whatever is
// drawn in between for other keys.  (The std:: distributions differ between libraries.)
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>

#include <Eigen/Core>

namespace chorus::synthetic {

class Draw {
 public:
  /// The parts of the key, in order: a seed, the purpose of the draw, which sensor, which frame,
  /// ...
  explicit Draw(std::initializer_list<std::uint64_t> key) {
    for (const std::uint64_t part : key) state_ = mix(state_ ^ mix(part + kGolden));
  }

  /// 64 random bits (splitmix64).
  std::uint64_t bits() {
    state_ += kGolden;
    return mix(state_);
  }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double least, double most) { return least + (most - least) * uniform(); }

  /// Standard normal (Box-Muller; uses only one value of each pair).
  double gauss() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  Eigen::Vector3d gauss3() {
    const double x = gauss();
    const double y = gauss();
    return {x, y, gauss()};
  }

 private:
  static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ull;
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  std::uint64_t state_ = 0;
};

}  // namespace chorus::synthetic
