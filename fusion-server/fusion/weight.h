// A weight in [0, 1]: created only by clamping, and closed under products; zero means "ignore".
#pragma once

namespace chorus::fusion {

class Weight {
 public:
  constexpr Weight() = default;
  /// NaN and negative values give zero, values above one give one.
  [[nodiscard]] static constexpr Weight clamped(double value) noexcept {
    return Weight(value > 0.0 ? (value < 1.0 ? value : 1.0) : 0.0);
  }
  [[nodiscard]] constexpr double value() const noexcept { return value_; }
  friend constexpr Weight operator*(Weight a, Weight b) noexcept {
    return Weight(a.value_ * b.value_);
  }
  friend constexpr auto operator<=>(Weight, Weight) = default;

 private:
  constexpr explicit Weight(double value) : value_(value) {}
  double value_ = 0.0;
};

}  // namespace chorus::fusion
