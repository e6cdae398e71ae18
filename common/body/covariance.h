// Covariance: how uncertain the measured place or direction of a joint is, as a symmetric 3x3
// matrix, or "not known".
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
  /// Terms of the upper triangle, in the order xx xy xz yy yz zz.
  static constexpr std::size_t kTerms = 6;

  Covariance() = default;  ///< Not known.
  /// Takes the upper triangle of `matrix`.
  explicit Covariance(const Eigen::Matrix3d& matrix);
  explicit Covariance(const std::array<double, kTerms>& upper);

  [[nodiscard]] bool known() const noexcept { return known_; }
  /// All zero if the covariance is not known.
  [[nodiscard]] Eigen::Matrix3d matrix() const;
  [[nodiscard]] double term(std::size_t i) const { return static_cast<double>(upper_[i]); }

  /// R C R^T with R = `rotation`: the covariance after the joint's space has been turned by R.
  [[nodiscard]] Covariance turned(const Eigen::Matrix3d& rotation) const;

  /// True when every term is finite and no direction has a negative variance, apart from what
  /// rounding on the wire can cause.
  [[nodiscard]] bool plausible() const;

  bool operator==(const Covariance&) const = default;

 private:
  std::array<float, kTerms> upper_{};
  bool known_ = false;
};

/// Interpolates linearly from a (share 0) to b (share 1); unknown unless both are known.
[[nodiscard]] Covariance between(const Covariance& a, const Covariance& b, double share);

}  // namespace chorus
