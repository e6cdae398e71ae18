// Random joint error and the tracked / inferred flag: coloured, white, teleports.
//
// Time enters as seconds since the epoch; everything but the Ornstein-Uhlenbeck state is a pure
// function of the keys.
#pragma once

#include <array>
#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/kinect/profile.h"
#include "common/synthetic/kinect/shared_error.h"

namespace chorus::synthetic::kinect {

/// Who errs: one sensor looking at one person.
struct ErrorKeys {
  std::uint64_t seed = 1;
  std::uint64_t sensor = 0;
  std::uint64_t person = 0;
};

/// A smooth coloured process of unit variance, three axes: two equal first-order lags, one after
/// the other.  Correlation after a lag L is (1 + L/a) exp(-L/a) with a = tau / 2; unlike one lag
/// alone it adds nothing to white noise.
class SmoothNoise {
 public:
  void advance(double passed, double tau, Draw draw);
  [[nodiscard]] Eigen::Vector3d value() const;

 private:
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d second_ = Eigen::Vector3d::Zero();
  bool started_ = false;
};

/// The coloured error's memory: one process per joint and one common to the core, each sensor's
/// own, and the part that sensors share; a second one per joint for when it is hidden.
struct ColouredState {
  std::array<SmoothNoise, kJointCount> joint{};
  std::array<SmoothNoise, kJointCount> hidden{};
  SmoothNoise core;
  SharedError shared;
};

/// How the body stands and moves: what scales the error.
struct Stand {
  View view;
  double misjudged = 0.0;                    ///< Yaw the SDK is wrong by [rad]
  double distance = 2.5;                     ///< Sensor to neck [m]
  std::array<double, kJointCount> speed{};   ///< Of each joint [m/s]
  std::array<double, kJointCount> hidden{};  ///< Of each joint as labelled, noticed share: 0 seen.
};

/// Smooth unit-variance noise over one coordinate (time [s]) with correlation length `tau`; pure.
[[nodiscard]] Eigen::Vector3d lattice_noise(std::initializer_list<std::uint64_t> key, double time,
                                            double tau);

/// Share of time that passes for the error of a joint of this speed: rest_share at rest, 1 when
/// moving.
[[nodiscard]] double activity(double speed, const ColouredError& coloured);

/// Tracked or inferred, in runs of about `state_hold`; occluded joints mostly inferred, core
/// joints, shoulders and hips never when visible.
[[nodiscard]] JointState shown_state(JointId id, double visible_share, double time,
                                     const Visibility& visibility, const ErrorKeys& keys);

/// One frame: when it is and how long after the one before [s].
struct Moment {
  double time = 0.0;
  double dt = 0.033;
};

/// One frame further.
void advance(ColouredState& state, const Stand& stand, const Moment& moment, const Profile& profile,
             const ErrorKeys& keys);

/// Adds coloured and white error, that of hidden joints, and teleports to every seen joint.
void add_errors(Skeleton<SensorSpace>& body, const ColouredState& state, const Stand& stand,
                double time, const Profile& profile, const ErrorKeys& keys);

/// The true mean square, about nothing, of what add_errors() adds to a seen joint of this body
/// [m^2]: the covariance of what is random, and what is not.
[[nodiscard]] Eigen::Matrix3d error_moment(JointId id, const Skeleton<SensorSpace>& body,
                                           const Stand& stand, double time, const Profile& profile,
                                           const ErrorKeys& keys);

}  // namespace chorus::synthetic::kinect
