#include "services/sensor/device/suit/suit_frames.h"

#include <utility>

namespace chorus::suit {
namespace {

// Of a joint within the pose: three degrees over an arm's or a leg's bones [m].
constexpr double kPoseSigma = 0.03;
constexpr double kUsualStature = 1.75;  // [m]
// A pose is used once this share of a period has passed, because suits do not stream evenly.
constexpr double kNearly = 0.9;

}  // namespace

SuitFrames::SuitFrames(SensorId sensor, const SuitSettings& settings)
    : sensor_(std::move(sensor)), settings_(settings) {}

SuitPose SuitFrames::sized(const SuitPose& pose) {
  if (!factor_) {
    const double found = stature_of(pose);
    if (!(found > 0.0)) return pose;
    factor_ = settings_.stature > 0.0 ? settings_.stature / found : 1.0;
    walk_.emplace(settings_.stature > 0.0 ? settings_.stature : found);
  }
  return *factor_ == 1.0 ? pose : scaled(pose, *factor_);
}

/// Where the walk is or, if the suit's own program is believed, where that says it is.
Walked SuitFrames::where(const SuitPose& pose, const Eigen::Vector3d& claimed) {
  if (!walk_) walk_.emplace(kUsualStature);
  const Walked walked = walk_->next(pose);
  if (settings_.walk) return walked;
  const double way = claimed_ ? (claimed - *claimed_).norm() : 0.0;
  claimed_ = claimed;
  // Its errors are those of walking too.
  stated_ = walked;
  stated_.place = claimed;
  stated_.distance += way;
  return stated_;
}

std::optional<SensorFrame> SuitFrames::next(SuitInstant instant) {
  const SuitPose pose = sized(instant.pose);
  const Walked walked = where(pose, instant.claimed);
  const double period = 1.0 / settings_.max_rate_hz;
  if (last_ && seconds(instant.captured - *last_) < kNearly * period) return std::nullopt;
  last_ = instant.captured;
  SensorFrame frame;
  frame.sensor = sensor_;
  frame.sequence = ++sequence_;
  frame.captured = instant.captured;
  frame.floor = FloorPlane{};
  if (pose.joints[JointId::SpineBase].seen()) {
    BodyFrame body;
    body.id = BodyId{1};
    body.captured = instant.captured;
    body.skeleton = to_sensor(Eigen::Isometry3d::Identity(), walked_body(pose, walked, kPoseSigma));
    frame.bodies.push_back(std::move(body));
  }
  return frame;
}

}  // namespace chorus::suit
