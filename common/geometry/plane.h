// Planes n.x + d = 0 with unit normal n, offset d [m].
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus {

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  ///< Unit length.
  double offset = 0.0;                                ///< d [m]; distance of the origin, signed.

  /// Signed distance of a point; positive on the side the normal points to.
  [[nodiscard]] double distance(const Eigen::Vector3d& x) const { return normal.dot(x) + offset; }

  /// To the bit.
  bool operator==(const Plane& other) const {
    return normal == other.normal && offset == other.offset;
  }
};

/// Normalises (a, b, c, d); refuses a zero or non-finite normal.
[[nodiscard]] Result<Plane> make_plane(double a, double b, double c, double d);

/// Least-squares plane through at least three points that do not lie on one line (Otto 5.2.1's
/// regression plane); the normal is turned so that it has positive y.
[[nodiscard]] Result<Plane> fit_plane(std::span<const Eigen::Vector3d> points);

/// The rotation and height that make the plane y = 0: levelled_from_sensor.  Takes the shortest
/// turn of the normal onto +y, so yaw is kept as it is.
[[nodiscard]] Eigen::Isometry3d level(const Plane& floor_in_sensor);

}  // namespace chorus
