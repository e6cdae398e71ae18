// The body around a skeleton, as tapered capsules (Madaras et al. 3.4, Fig. 4: a skeleton with a
// radius at each node).  Pure.
//
// The paper makes a mesh of quads from skeleton and radii (SQM) and skins it; only its outline is
// used.  Two spheres and the cone between them have an outline in closed form, so there is nothing
// to render: each capsule's outline is two tangents and two arcs, and what lies within another
// capsule's outline is inside the body.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "common/body/skeleton.h"
#include "common/sensor/camera_image.h"

namespace chorus::silhouette {

struct ShapedBone {
  JointId from;
  JointId to;
  double from_radius;  ///< [m]
  double to_radius;    ///< [m]
};

/// Radii by stature and girth.  `girth` 1 is a person of usual build.
[[nodiscard]] std::vector<ShapedBone> usual_shape(double stature, double girth = 1.0);

/// One capsule in a picture: two circles and their tangents [px].
struct FlatCapsule {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double a_radius = 0.0;
  double b_radius = 0.0;
  double a_depth = 1.0;  ///< Of the spheres' centres, ahead of the camera [m].
  double b_depth = 1.0;
};

/// The capsules of a body, in camera axes (x right, y down, z ahead), as a picture shows them.
/// Bones with a joint that is not seen, or behind the camera, are left out.
[[nodiscard]] std::vector<FlatCapsule> flat_capsules(const Skeleton<WorldSpace>& body,
                                                     std::span<const ShapedBone> shape,
                                                     const Eigen::Isometry3d& world_from_sensor,
                                                     const Intrinsics& camera);

/// The part of a picture that the capsules cover [px]; empty without capsules.
[[nodiscard]] Eigen::AlignedBox2d box_of(std::span<const FlatCapsule> capsules);

/// Signed distance of a pixel from the outline of a capsule, negative inside [px].
[[nodiscard]] double distance(const FlatCapsule& capsule, const Eigen::Vector2d& pixel);

/// A point of the body's outline.
struct OutlinePoint {
  Eigen::Vector2d pixel;
  Eigen::Vector2d normal;  ///< Outwards, of unit length.
  double depth = 1.0;      ///< [m]
};

/// Points of the outline, about `spacing` pixels apart.
[[nodiscard]] std::vector<OutlinePoint> outline_of(std::span<const FlatCapsule> capsules,
                                                   double spacing);

}  // namespace chorus::silhouette
