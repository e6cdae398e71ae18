// One generic body fitted to the depth points of one person: articulated iterated closest point.
//
// Each round every point chooses the nearest capsule, and one Gauss-Newton step moves all nodes at
// once; bones keep their length, a trunk keeps its shape, limbs without evidence go with the trunk.
#pragma once

#include <array>
#include <span>

#include "common/synthetic/depth/foreground.h"
#include "common/synthetic/depth/generic_body.h"

namespace chorus::synthetic::depth {

/// What one image says of one person.
struct Evidence {
  std::span<const SurfacePoint> points;
  double share = 1.0;  ///< Of all the person's points that `points` are.
  const DepthImage* image = nullptr;
  const DepthCamera* camera = nullptr;
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
};

struct FittedBody {
  Nodes now = Nodes::Zero();
  Nodes before = Nodes::Zero();  ///< One frame earlier.
  double height = kGenericHeight;
  std::array<double, kNodeCount> support{};  ///< Points near a node, of those that a free view has.
  double misfit = 0.0;                       ///< Mean distance of points to the surface [m]
};

/// Distance of a point to the body's surface [m].
[[nodiscard]] double distance_to(const Nodes& nodes, double height, const Eigen::Vector3d& point);

/// The next frame begins: everything moves on a little as it did.
void predict(FittedBody& body);

/// `rounds` Gauss-Newton steps from where the body stands; then support and misfit.
void fit(FittedBody& body, const Evidence& evidence, int rounds);

}  // namespace chorus::synthetic::depth
