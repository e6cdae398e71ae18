// How uncertain a joint's measured place or direction is: a symmetric 3x3 covariance, or "not
// known".
//
// The axes are those of the joint's space.  The unit is [m^2] for a point and [rad^2] for a ray's
// unit direction.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace chorus {

class Covariance {
 public:
  /// In the order xx xy xz yy yz zz.
  static constexpr std::size_t kTerms = 6;

  Covariance() = default;  ///< Not known.
  /// Takes the upper triangle.
  explicit Covariance(const Eigen::Matrix3d& matrix);
  explicit Covariance(const std::array<double, kTerms>& upper);

  [[nodiscard]] bool known() const noexcept { return known_; }
  /// Zero while it is not known.
  [[nodiscard]] Eigen::Matrix3d matrix() const;
  [[nodiscard]] double term(std::size_t i) const { return static_cast<double>(upper_[i]); }

  /// R C R^T: the same covariance in the axes that `rotation` leads to.
  [[nodiscard]] Covariance turned(const Eigen::Matrix3d& rotation) const;

  /// True when all is finite and no direction has a negative variance beyond rounding on the wire.
  [[nodiscard]] bool plausible() const;

  bool operator==(const Covariance&) const = default;

 private:
  std::array<float, kTerms> upper_{};
  bool known_ = false;
};

/// Interpolates linearly, 0: a, 1: b; unknown unless both are known.
[[nodiscard]] Covariance between(const Covariance& a, const Covariance& b, double share);

}  // namespace chorus
