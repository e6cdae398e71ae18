// Planes n.x + d = 0 with unit normal n, offset d [m].
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus {

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  ///< Unit length.
  double offset = 0.0;  ///< d [m]: signed distance of the origin from the plane.

  /// Signed distance of a point; positive on the side the normal points to.
  [[nodiscard]] double distance(const Eigen::Vector3d& x) const { return normal.dot(x) + offset; }

  /// Compares bit for bit.
  bool operator==(const Plane& other) const {
    return normal == other.normal && offset == other.offset;
  }
};

/// Normalises (a, b, c, d); refuses a zero or non-finite normal and a non-finite offset.
[[nodiscard]] Result<Plane> make_plane(double a, double b, double c, double d);

/// Least-squares plane (Otto 5.2.1's regression plane); needs at least three points that are not on
/// one line.  The sign of the normal is chosen so that its y is not negative.
[[nodiscard]] Result<Plane> fit_plane(std::span<const Eigen::Vector3d> points);

/// levelled_from_sensor: the rotation and the height that move the plane to y = 0.  Turns the
/// normal onto +y by the shortest arc, so yaw is kept.
[[nodiscard]] Eigen::Isometry3d level(const Plane& floor_in_sensor);

}  // namespace chorus
