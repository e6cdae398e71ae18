// Parameters of the body filter (body_filter.h); docs/papers/body.md says where each comes from.
// A part whose size is zero is switched off.
#pragma once

#include "common/base/units.h"
#include "common/time/timestamp.h"

namespace chorus::fusion {

struct BodyModel {
  /// Start of the estimate of misfits (misfit_size.h): standard deviation of the ratio by which the
  /// whole body of a view is too large or too small.
  double scale = 0.06;
  /// The same for the angle [rad] by which the whole body of a view is turned about the vertical
  /// axis when it is seen from the side. It is nearly zero up to `turn_from`, and reaches this
  /// value at `turn_full`; both are angles between frontal and side-on.
  double turn = deg(20);
  double turn_from = deg(40);
  double turn_full = deg(90);
  /// A view whose body is found turned is wrong in other ways too: for each radian beyond a slight
  /// turn its points have this much more standard deviation [m / rad].
  double turn_doubt = 0.16;
  /// Standard deviation of a bone's length [m], and the time over which the length is learned.
  double bone = 0.003;
  Duration bone_memory = std::chrono::seconds(60);
  /// Standard deviation per axis of the place of a foot or of a part of a hand in the axes of its
  /// limb, as a fraction of its distance from the ankle or wrist (limb_ends.h); 0: it is anywhere.
  double limb_end = 0.2;
  /// Rate at which each sensor's bias of each joint is learned [1/s]; 0: no biases.
  double bias_rate = 3.0;
  /// Biases fade by a factor of e in this time, and also while the person turns by this angle
  /// [rad], because a sensor errs differently about somebody whom it sees from another side.
  Duration bias_memory = std::chrono::milliseconds(300);
  double bias_turn = deg(15);
  /// Time constant with which a joint follows after a view of it has begun, ended, or turned into a
  /// guess or out of one (handover.h); 0: it follows at once.
  Duration handover = std::chrono::milliseconds(70);
  /// How far a joint may be from where its motion had it expected after kLeapTime, in proportion
  /// after longer times [m], when no two views tell of more; what is beyond is handed over like a
  /// view that began.  0: any distance.
  double leap = 0.04;
  static constexpr double kLeapTime = 1.0 / 30.0;  ///< [s]
  /// For the weights of the views, the pose error (pose_error.h) of every joint is multiplied by
  /// `pose`, and that of an inferred joint also by `inferred`.
  double pose = 0.5;
  double inferred = 3.0;
  /// Huber's threshold, in standard deviations that include this pose error.
  double huber = 1.0;
  /// Spectral densities of the white-noise acceleration of a resting and of a moving joint [m^2 /
  /// s^3]; `limb` is a factor for limbs.  Resting 0: no filter over time.
  double resting = 0.0005;
  double moving = 3.0;
  double limb = 4.0;
  /// Fraction of a joint's standard deviation that is white noise, independent at each instant.
  double white = 0.15;
  /// The next three affect the stated errors only; 0: unused.  Sensors that differ in scale also
  /// have wrong proportions: the error is this fraction of the difference in scale, times a joint's
  /// distance from the trunk.
  double proportion = 0.75;
  /// Start of the estimate of how far views differ (disagreement.h), in units of their stated
  /// variances, by which these are multiplied; 0: they are used as they are.
  double disagreement = 0.5;
  /// Standard deviation per axis of the error that all views share [m], per unit of the estimated
  /// disagreement.
  double common = 0.013;
  /// How long a joint that nobody sees is predicted.
  Duration carry = std::chrono::seconds(1);

  bool operator==(const BodyModel&) const = default;
};

}  // namespace chorus::fusion
