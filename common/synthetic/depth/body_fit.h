// Fits a generic body to the depth points of one person, by articulated iterated closest point.
//
// In each round every point is assigned to the nearest capsule, and one Gauss-Newton step moves all
// nodes together.  Bones nearly keep their lengths and the trunk its shape; limbs without points
// move with the trunk and hang down.
#pragma once

#include <array>
#include <span>

#include "common/synthetic/depth/foreground.h"
#include "common/synthetic/depth/generic_body.h"

namespace chorus::synthetic::depth {

/// What one image shows of one person.
struct Evidence {
  std::span<const SurfacePoint> points;
  double share = 1.0;  ///< `points` as a share of all the person's points.
  const DepthImage* image = nullptr;
  const DepthCamera* camera = nullptr;
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
};

struct FittedBody {
  Nodes now = Nodes::Zero();
  Nodes before = Nodes::Zero();  ///< One frame earlier.
  double height = kGenericHeight;
  /// For each node: the number of points near it, relative to the number if nothing hid it.
  std::array<double, kNodeCount> support{};
  double misfit = 0.0;  ///< Mean distance of points to the surface; large ones are capped [m]
};

/// Distance of a point to the body's surface [m].
[[nodiscard]] double distance_to(const Nodes& nodes, double height, const Eigen::Vector3d& point);

/// Predicts the next frame: nodes keep moving as before, but more slowly; those without enough
/// points move with the trunk.
void predict(FittedBody& body);

/// Makes `rounds` Gauss-Newton steps from the current pose, then computes support and misfit.
void fit(FittedBody& body, const Evidence& evidence, int rounds);

}  // namespace chorus::synthetic::depth
