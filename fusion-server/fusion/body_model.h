// Parameters of the body filter (body_filter.h); docs/papers/body.md says where each comes from.
// A part whose size is zero is switched off.
#pragma once

#include "common/base/units.h"
#include "common/time/timestamp.h"

namespace chorus::fusion {

struct BodyModel {
  /// How far a sensor's whole body is off in size, standard deviation of the ratio.
  double scale = 0.06;
  /// How far it is turned about the vertical axis while it is seen from the side [rad]; nothing up
  /// to `turn_from`, in full from `turn_full` on, angles between frontal and side-on.
  double turn = deg(20);
  double turn_from = deg(40);
  double turn_full = deg(90);
  /// How well a bone keeps its length [m], and over what time its length is learned.
  double bone = 0.003;
  Duration bone_memory = std::chrono::seconds(60);
  /// What a sensor has a joint off by is followed at this rate [1/s], 0: not at all, and forgotten
  /// in this time.
  double bias_rate = 3.0;
  Duration bias_memory = std::chrono::milliseconds(300);
  /// Huber's threshold, in standard deviations that have the pose errors in them.
  double huber = 1.0;
  /// Densities of white acceleration of a resting and of a moving joint [m^2 / s^3]; limbs move,
  /// and rest, livelier by `limb`.  Resting 0: no filter over time.
  double resting = 0.003;
  double moving = 20.0;
  double limb = 4.0;
  /// What of the stated standard deviation of one instant is new at the next.
  double white = 0.25;
  /// How long a joint that nobody sees is carried.
  Duration carry = std::chrono::seconds(1);

  bool operator==(const BodyModel&) const = default;
};

}  // namespace chorus::fusion
