// Fits under multivariate Student-t errors, by expectation-maximisation: robust, and with a
// likelihood that can be compared.  Derived in docs/papers/registration.md, Section 10.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::registration {

/// Corresponding points; those of one frame are next to each other.
struct Points {
  std::vector<Eigen::Vector3d> target;
  std::vector<Eigen::Vector3d> source;
  std::vector<std::size_t> frame;  ///< Frame of the source that each point belongs to.
};

/// One frame's -2 log likelihood.
struct Loss {
  std::size_t frame = 0;
  double value = 0.0;
};

/// A place of the source, and how well it fits each frame.
struct StudentFit {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  std::vector<Loss> losses;  ///< One per frame, in order.
  /// Frames per independent frame; above one because frames are correlated.
  double inflation = 1.0;
};

/// Fits yaw and translation, or six degrees of freedom if not levelled; none if the points do not
/// determine them.
[[nodiscard]] std::optional<StudentFit> fit_place(const Points& points, bool levelled);

/// Number of values per independent value: the sum of the autocorrelation over all lags, up to the
/// first at which it is about zero.
[[nodiscard]] double inflation_of(const std::vector<Eigen::Vector3d>& series);

}  // namespace chorus::registration
