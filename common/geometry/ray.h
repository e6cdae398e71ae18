// Half-lines from an eye point, and the point nearest to several of them.
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace chorus {

struct Ray {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< Unit vector.
};

/// Distance of a point from the ray [m]; for a point behind the eye, distance from the eye.
[[nodiscard]] double distance(const Ray& ray, const Eigen::Vector3d& point);

/// The point of the ray that is nearest to `point`.
[[nodiscard]] Eigen::Vector3d nearest_on(const Ray& ray, const Eigen::Vector3d& point);

/// Projector onto the plane perpendicular to a unit direction: I - d d^T.
[[nodiscard]] Eigen::Matrix3d across(const Eigen::Vector3d& direction);

/// The point with the least sum of squared distances to the rays' lines.  None for fewer than two
/// rays, or when all are parallel to within about 5 degrees, so that the depth would be a guess.
[[nodiscard]] std::optional<Eigen::Vector3d> meeting_point(std::span<const Ray> rays);

/// Shortest distance between two rays [m]; none where meeting_point() returns none or a point
/// behind an eye.
[[nodiscard]] std::optional<double> distance(const Ray& a, const Ray& b);

}  // namespace chorus
