#include "common/synthetic/kinect/yaw_behaviour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"

namespace chorus::synthetic::kinect {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr std::uint64_t kPurpose = 931;

bool is_leg(JointId id) { return id >= JointId::HipLeft && id <= JointId::FootRight; }

bool is_core(JointId id) { return mirror(id) == id; }

Skeleton<SensorSpace> mirrored_labels(const Skeleton<SensorSpace>& body) {
  Skeleton<SensorSpace> swapped = body;
  for (const auto& [left, right] : kMirrorPairs) std::swap(swapped[left], swapped[right]);
  return swapped;
}

/// Turns every joint except those of the spine about the vertical through the spine: joints of the
/// legs by the error of the hips' yaw, the others by that of the shoulders'.
void turn_laterals(Skeleton<SensorSpace>& body, double shoulder_error, double hip_error) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    if (is_core(id) || !body[id].seen()) continue;
    const Joint& centre = body[is_leg(id) ? JointId::SpineBase : JointId::SpineShoulder];
    const Eigen::Quaterniond turn = about_y(is_leg(id) ? hip_error : shoulder_error);
    body[id].position = centre.position + turn * (body[id].position - centre.position);
    body[id].orientation = turn * body[id].orientation;
  }
}

}  // namespace

double shown_yaw(double yaw, double slope, const YawBehaviour& behaviour) {
  const double size = std::abs(yaw);
  if (size <= behaviour.reliable) return yaw;
  return std::copysign(behaviour.reliable + slope * (size - behaviour.reliable), yaw);
}

YawBehaviour own_behaviour(YawBehaviour behaviour, std::uint64_t seed, std::uint64_t sensor) {
  Draw draw{kPurpose, seed, sensor};
  const double both = behaviour.flip_own * draw.uniform(-1.0, 1.0);
  const double back = behaviour.flip_back_own * draw.uniform(-1.0, 1.0);
  behaviour.flip_to_rear += both;
  behaviour.flip_to_front = std::min(behaviour.flip_to_front + both + back, behaviour.flip_to_rear);
  return behaviour;
}

void advance(FlipState& state, double facing, double dt, const YawBehaviour& behaviour) {
  const double size = std::abs(facing);
  if (!state.met) {
    state.rear = size > 0.5 * (behaviour.flip_to_rear + behaviour.flip_to_front);
    state.blend = state.rear ? 1.0 : 0.0;
    state.met = true;
  }
  if (!state.rear && size > behaviour.flip_to_rear) state.rear = true;
  if (state.rear && size < behaviour.flip_to_front) state.rear = false;
  const double step = behaviour.flip_time > 0 ? dt / behaviour.flip_time : 1.0;
  state.blend = std::clamp(state.blend + (state.rear ? step : -step), 0.0, 1.0);
}

double misjudged_yaw(double facing, const FlipState& state, const YawBehaviour& behaviour) {
  const auto wrong_by = [&](double yaw) {
    return std::abs(shown_yaw(yaw, behaviour.shoulder_slope, behaviour) - yaw);
  };
  return (1.0 - state.blend) * wrong_by(facing) +
         state.blend * wrong_by(wrap_angle(facing - kHalfTurn));
}

Skeleton<SensorSpace> as_shown(const Skeleton<SensorSpace>& body, double facing,
                               const FlipState& state, const YawBehaviour& behaviour) {
  // In the rear state the SDK takes the back for the front, so the yaw counts from behind.
  const auto shown_for = [&](bool rear) {
    const double yaw = rear ? wrap_angle(facing - kHalfTurn) : facing;
    Skeleton<SensorSpace> shown = rear ? mirrored_labels(body) : body;
    turn_laterals(shown, shown_yaw(yaw, behaviour.shoulder_slope, behaviour) - yaw,
                  shown_yaw(yaw, behaviour.hip_slope, behaviour) - yaw);
    return shown;
  };
  if (state.blend <= 0.0) return shown_for(false);
  if (state.blend >= 1.0) return shown_for(true);
  Skeleton<SensorSpace> between = shown_for(false);
  const Skeleton<SensorSpace> rear = shown_for(true);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint& joint = between.joints[i];
    joint.position += state.blend * (rear.joints[i].position - joint.position);
    if (joint.state == JointState::Tracked && !is_core(static_cast<JointId>(i))) {
      joint.state = JointState::Inferred;
    }
  }
  return between;
}

}  // namespace chorus::synthetic::kinect
