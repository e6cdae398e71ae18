#include "common/synthetic/walker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/rotation.h"

namespace chorus::synthetic {
namespace {

constexpr double kSwayRate = 0.25;    // Approximate rate of breathing and balancing [Hz].
constexpr double kSwayReach = 0.004;  // [m]

PathScript path_of(const WalkerScript& script, const Gait& gait, double body_scale) {
  PathScript path;
  path.kind = script.path;
  path.seed = script.seed;
  path.centre = script.centre;
  path.reach = std::max(0.0, script.reach);
  path.speed = script.speed;
  path.stride = gait.stride() * body_scale;
  path.period = gait.period();
  return path;
}

}  // namespace

Walker::Walker(const WalkerScript& script)
    : body_scale_(std::clamp(script.body_scale, 0.5, 1.5)),
      gait_(&Gait::built_in(static_cast<std::size_t>(script.seed))),
      path_(path_of(script, *gait_, body_scale_)) {}

Skeleton<WorldSpace> Walker::at(Duration since_epoch) const {
  const PathPoint point = path_.at(since_epoch);
  const double loop = seconds(path_.loop());
  // The loop closes only with a whole number of sways.
  const double sways = std::max(1.0, std::round(kSwayRate * loop));
  const double angle = 2 * std::numbers::pi * sways * seconds(since_epoch % path_.loop()) / loop;
  const double sway = kSwayReach * std::sin(angle);

  const Eigen::Quaterniond world_from_walk = about_y(point.heading);
  const Eigen::Vector3d origin(point.place.x(), 0.0, point.place.y());
  Skeleton<WorldSpace> body = gait_->pose(point.phase, point.amplitude);
  apply(point.reach, body);
  for (Joint& joint : body.joints) {
    Eigen::Vector3d in_walk = body_scale_ * joint.position;
    in_walk.x() += sway * in_walk.y();  // An upright body sways about its feet.
    joint.position = origin + world_from_walk * in_walk;
    if (is_unit(joint.orientation)) joint.orientation = world_from_walk * joint.orientation;
  }
  return body;
}

}  // namespace chorus::synthetic
