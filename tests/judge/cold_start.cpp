#include "tests/judge/cold_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/gait.h"

namespace chorus::bench {
namespace {

using synthetic::Gait;
using synthetic::Walker;

constexpr double kStanding = 4.0;    // [s]
constexpr double kBackwards = 3.0;   // [s]
constexpr double kBackSpeed = 0.6;   // [m/s]
constexpr double kEnterSpeed = 0.9;  // [m/s]
constexpr double kOutside = 4.0;     // distance from the middle at which they come in [m]
constexpr double kStopping = 0.5;    // [s]
constexpr double kStride = 0.8;      // amplitude of the strides
constexpr double kRaising = 0.7;     // time to raise the hand, and to lower it again [s]
constexpr double kWaveRate = 1.2;    // [Hz]
constexpr double kWaveReach = 0.15;  // [m]
constexpr std::uint64_t kPurpose = 761;

/// The place and heading at which the walk starts, after the opening.
struct Start {
  Eigen::Vector2d place;
  double heading = 0.0;  ///< [rad]

  [[nodiscard]] Eigen::Vector2d forward() const { return {std::sin(heading), std::cos(heading)}; }
};

Start start_of(const Walker& walker) {
  const synthetic::PathPoint point = walker.path().at(Duration{0});
  return {point.place, point.heading};
}

/// A pose during the opening (standing, waving, walking backwards or coming in), relative to where
/// the walk will start.
struct Pose {
  double ahead = 0.0;  ///< In front of the start, along its heading [m]
  double phase = 0.0;  ///< Phase of the gait; decreases while the person walks backwards.
  double amplitude = 0.0;
  synthetic::Reach reach{};
};

synthetic::Reach waving(double left_over) {
  const double up = std::clamp(std::min(left_over, kStanding - left_over) / kRaising, 0.0, 1.0);
  const double swing = kWaveReach * std::sin(2.0 * std::numbers::pi * kWaveRate * left_over);
  return {false, up, {-0.35 + swing, 1.65, 0.25}};
}

/// Pose of a walk that slows down to a stop during its last kStopping seconds; `left_over` is the
/// time before its end [s].
Pose walking(double left_over, double speed, double stride) {
  const double slow = std::min(left_over, kStopping);
  const double way = speed * (left_over - slow + 0.5 * slow * slow / kStopping);
  return {way, way / stride, kStride * slow / kStopping};
}

Pose pose_at(ColdStart start, double left_over, double stride) {
  Pose pose;
  if (start == ColdStart::Wave) pose.reach = waving(left_over);
  if (start == ColdStart::Back) pose = walking(left_over, kBackSpeed, stride);
  if (start == ColdStart::Enter) {
    pose = walking(left_over, kEnterSpeed, stride);
    pose.ahead = -pose.ahead;
    pose.phase = -pose.phase;
  }
  return pose;
}

Skeleton<WorldSpace> body_in(const Pose& pose, const Start& start, const Gait& gait,
                             double body_scale) {
  const Eigen::Vector2d place = start.place + pose.ahead * start.forward();
  const Eigen::Quaterniond world_from_walk = about_y(start.heading);
  Skeleton<WorldSpace> body = gait.pose(pose.phase, pose.amplitude);
  apply(pose.reach, body);
  for (Joint& joint : body.joints) {
    joint.position =
        Eigen::Vector3d(place.x(), 0, place.y()) + world_from_walk * (body_scale * joint.position);
    if (is_unit(joint.orientation)) joint.orientation = world_from_walk * joint.orientation;
  }
  return body;
}

/// Length of the straight path on which a person comes in, from kOutside to `start` [m].
double way_in(const Start& start) {
  const double along = start.place.dot(start.forward());
  const double aside = start.place.squaredNorm() - along * along;
  return along + std::sqrt(std::max(0.0, kOutside * kOutside - aside));
}

/// Angle by which the scene is turned about the middle, so that the person comes in midway between
/// two sensors [rad].
double turn_between(const Start& start, const ColdScript& script) {
  if (script.start != ColdStart::Enter || script.ring.count == 0) return 0.0;
  const double along = start.place.dot(start.forward());
  const double aside = start.place.squaredNorm() - along * along;
  const double radius = script.ring.radius;
  const double back = along + std::sqrt(std::max(0.0, radius * radius - aside));
  const Eigen::Vector2d gate = start.place - back * start.forward();
  const double step = 2.0 * std::numbers::pi / static_cast<double>(script.ring.count);
  const auto gap = synthetic::Draw{kPurpose, script.seed}.bits() % script.ring.count;
  return (static_cast<double>(gap) + 0.5) * step - std::atan2(gate.x(), gate.y());
}

double length_of(ColdStart kind, const Start& start) {
  if (kind == ColdStart::Back) return kBackwards;
  if (kind != ColdStart::Enter) return kStanding;
  return way_in(start) / kEnterSpeed + 0.5 * kStopping;
}

Skeleton<WorldSpace> turned(Skeleton<WorldSpace> body, double yaw) {
  const Eigen::Quaterniond turn = about_y(yaw);
  for (Joint& joint : body.joints) {
    joint.position = turn * joint.position;
    if (is_unit(joint.orientation)) joint.orientation = turn * joint.orientation;
  }
  return body;
}

}  // namespace

synthetic::Person cold_starter(const ColdScript& script) {
  synthetic::WalkerScript walk;
  walk.seed = script.seed;
  walk.body_scale = script.body_scale;
  const Walker walker(walk);
  const Start start = start_of(walker);
  const Gait* const gait = &Gait::built_in(static_cast<std::size_t>(script.seed));
  const double yaw = turn_between(start, script);
  const double length = length_of(script.start, start);
  return [=](Duration since_epoch) {
    const double left_over = length - seconds(Timestamp{since_epoch} - script.begin);
    const auto body = left_over > 0 ? body_in(pose_at(script.start, left_over,
                                                      kStride * gait->stride() * script.body_scale),
                                              start, *gait, script.body_scale)
                                    : walker.at(from_seconds(-left_over));
    return turned(body, yaw);
  };
}

}  // namespace chorus::bench
