// What cameras without depth saw at one instant: the rays to one joint of the person who walks.
//
// A ray is the unit vector from a camera towards a joint, in the camera's own space.  Everything
// here is in the space and unit of the rig (ray_rig.h), which are those of one of its cameras.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "fusion-server/registration/trail.h"

namespace chorus::registration {

/// The distance at which a ray's joint is put where something has to be a point [m].
inline constexpr double kNominalDistance = 3.0;

/// rig_from_camera, by the camera's index.
using RayPlaces = std::map<std::size_t, Eigen::Isometry3d>;

struct RaySight {
  std::size_t camera = 0;
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
  double sigma = 0.01;   ///< Across the ray [rad]; only ratios matter.
  bool counted = false;  ///< True if it agrees with the others (meet()).
};

/// One joint at one instant.
struct RayPoint {
  double time = 0.0;     ///< Since the first instant [s].
  std::size_t slot = 0;  ///< Index into slots_of(JointChoice::All), which is the joint's number.
  std::vector<RaySight> seen;
  std::optional<Eigen::Vector3d> x = {};  ///< Where the counted rays meet; none: not known.
};

/// True if all bodies that the sensor saw are made of rays.
[[nodiscard]] bool sends_rays_alone(const WalkTrack& track);

/// The same frames with each ray as a point at kNominalDistance, so that a Trail can be made of
/// them.  Points stay.
[[nodiscard]] WalkTrack at_nominal_distance(WalkTrack track);

/// The rays of one trail at one instant, added to the points of that instant (one for each slot).
void add_sights(std::size_t camera, const TrailFrame& frame, std::vector<RayPoint>& points);

/// Joints that two or more cameras saw, in order of time, thinned out.  `cameras`: trails of
/// at_nominal_distance().
[[nodiscard]] std::vector<RayPoint> ray_points(const std::vector<Trail>& cameras, Duration max_gap);

/// Where the rays of a point meet: least squares of their angles; while one of three and more is
/// off by more than `gate` of its sigmas, the worst is left out.  Sets `x` and `counted`; none if
/// fewer than two agree, are in view of cameras with a place, or cross at 2.5 deg or more.
void meet(RayPoint& point, const RayPlaces& places, double gate);

/// The angle of a counted ray from the direction to `x`, in its sigmas.
[[nodiscard]] double ray_misfit(const RaySight& sight, const Eigen::Isometry3d& rig_from_camera,
                                const Eigen::Vector3d& x);

}  // namespace chorus::registration
