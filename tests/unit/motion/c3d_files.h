// C3D files for tests, in all byte orders and number formats of the user guide (c3d.org).
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace chorus::motion {

enum class Order { Intel = 84, Dec = 85, Mips = 86 };

struct C3dSpec {
  Order order = Order::Intel;
  float scale = -1.0f;  ///< Negative: the points are stored as floats.
  std::string units = "mm";
  std::vector<std::string> labels{"HipLeft", "Wand"};
  std::string x_screen = "+X";
  std::string y_screen = "+Y";
  int frames = 2;
  int analog = 3;  ///< Analog samples after each frame.
  /// Returns x, y, z in file units and the point's fourth word.
  std::function<std::array<double, 4>(int frame, int point)> at = [](int f, int p) {
    return std::array<double, 4>{100.0 + f, -200.0 * p, 1500.25, 2.0};
  };
};

class C3dBuilder {
 public:
  explicit C3dBuilder(C3dSpec spec) : spec_(std::move(spec)) {}

  std::string bytes() {
    std::string parameters = this->parameters(0);
    const std::size_t blocks = (parameters.size() + 511) / 512;
    parameters = this->parameters(static_cast<int>(2 + blocks));
    parameters.resize(512 * blocks, '\0');
    parameters[2] = static_cast<char>(blocks);
    std::string all = header(static_cast<int>(2 + blocks)) + parameters;
    for (int f = 0; f < spec_.frames; ++f) {
      for (int p = 0; p < points(); ++p) {
        const auto xyzr = spec_.at(f, p);
        for (std::size_t i = 0; i < 4; ++i)
          all += number(i < 3 && spec_.scale > 0 ? xyzr[i] / spec_.scale : xyzr[i]);
      }
      for (int a = 0; a < spec_.analog; ++a) all += number(7 * a);
    }
    return all;
  }

 private:
  [[nodiscard]] int points() const { return static_cast<int>(spec_.labels.size()); }
  [[nodiscard]] std::string word(int value) const {
    const auto low = static_cast<char>(value & 0xff);
    const auto high = static_cast<char>(value >> 8 & 0xff);
    return spec_.order == Order::Mips ? std::string{high, low} : std::string{low, high};
  }
  [[nodiscard]] std::string real(float value) const {
    const auto bits = std::bit_cast<std::uint32_t>(spec_.order == Order::Dec ? value * 4 : value);
    const int high = static_cast<int>(bits >> 16);
    const int low = static_cast<int>(bits & 0xffff);
    return spec_.order == Order::Intel ? word(low) + word(high) : word(high) + word(low);
  }
  [[nodiscard]] std::string number(double value) const {
    return spec_.scale < 0 ? real(static_cast<float>(value))
                           : word(static_cast<int>(std::lround(value)));
  }
  [[nodiscard]] std::string header(int data_start) const {
    std::string out{2, 0x50};
    out += word(points()) + word(spec_.analog) + word(1) + word(spec_.frames) + word(0) +
           real(spec_.scale) + word(data_start) + word(spec_.analog) + real(50.0f);
    out.resize(512, '\0');
    return out;
  }
  [[nodiscard]] std::string entry(int id, const std::string& name,
                                  const std::string& content) const {
    return std::string{static_cast<char>(name.size()), static_cast<char>(id)} + name +
           word(static_cast<int>(2 + content.size() + 1)) + content + std::string(1, '\0');
  }
  [[nodiscard]] static std::string text(const std::string& value) {
    return std::string{-1, 1, static_cast<char>(value.size())} + value;
  }
  [[nodiscard]] std::string parameters(int data_start) const {
    std::string names;
    for (std::string label : spec_.labels) {
      label.resize(12, ' ');
      names += label;
    }
    std::string out = std::string{1, 0x50, 1, static_cast<char>(spec_.order)};
    out += entry(-1, "POINT", "");
    out += entry(1, "USED", std::string{2, 0} + word(points()));
    out += entry(1, "FRAMES", std::string{2, 0} + word(spec_.frames));
    out += entry(1, "SCALE", std::string{4, 0} + real(spec_.scale));
    out += entry(1, "RATE", std::string{4, 0} + real(50.0f));
    out += entry(1, "DATA_START", std::string{2, 0} + word(data_start));
    out += entry(1, "UNITS", text(spec_.units));
    if (!spec_.x_screen.empty()) out += entry(1, "X_SCREEN", text(spec_.x_screen));
    if (!spec_.y_screen.empty()) out += entry(1, "Y_SCREEN", text(spec_.y_screen));
    out += entry(1, "LABELS", std::string{-1, 2, 12, static_cast<char>(points())} + names);
    return out + std::string(2, '\0');
  }

  C3dSpec spec_;
};

}  // namespace chorus::motion
