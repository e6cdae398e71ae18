#include "common/hand/anthropometry.h"

#include <cmath>

#include <fmt/format.h>

namespace chorus::hand {
namespace {

// Shares of people differ by 5 to 8 % (one standard deviation); a joint seen in the wrong place by
// more.
constexpr double kFarthest = 0.30;

}  // namespace

std::array<double, 3> parts_of(std::size_t finger) {
  const FingerBones& bones = kBones[finger];
  if (finger == 0) return {bones.metacarpal, bones.proximal, bones.tip()};
  return {bones.proximal, bones.middle, bones.tip()};
}

std::vector<std::string> implausible_parts(const Joints& joints) {
  std::vector<std::string> out;
  for (std::size_t f = 0; f < kFingers; ++f) {
    const auto usual = parts_of(f);
    std::array<double, 3> found{};
    double sum = 0.0, usual_sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      found[i] = (joints[hand_joint(f, i + 1)] - joints[hand_joint(f, i)]).norm();
      sum += found[i];
      usual_sum += usual[i];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const double ratio = sum > 0.0 ? found[i] / sum / (usual[i] / usual_sum) : 0.0;
      if (std::abs(ratio - 1.0) > kFarthest)
        out.push_back(fmt::format("part {} of the {} is {:.0f} % of what is usual for its finger",
                                  i + 1, kFingerNames[f], 100.0 * ratio));
    }
  }
  return out;
}

}  // namespace chorus::hand
