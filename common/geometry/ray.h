// Half-lines from an eye, and where several of them meet.
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace chorus {

struct Ray {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< Unit.
};

/// From the ray to a point; of a point behind the eye to the eye [m].
[[nodiscard]] double distance(const Ray& ray, const Eigen::Vector3d& point);

/// Where the ray comes nearest to the point.
[[nodiscard]] Eigen::Vector3d nearest_on(const Ray& ray, const Eigen::Vector3d& point);

/// Projects onto the plane across a unit direction: I - d d^T.
[[nodiscard]] Eigen::Matrix3d across(const Eigen::Vector3d& direction);

/// The point with the least sum of squared distances to the lines.  Nothing when fewer than two, or
/// when all are parallel to within about 5 degrees, so that their depth would be a guess.
[[nodiscard]] std::optional<Eigen::Vector3d> meeting_point(std::span<const Ray> rays);

/// Shortest distance between two rays [m]; nothing where meeting_point finds nothing, or finds it
/// behind an eye.
[[nodiscard]] std::optional<double> distance(const Ray& a, const Ray& b);

}  // namespace chorus
