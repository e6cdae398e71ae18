// Random joint error (coloured noise, white noise, teleports) and the state tracked or inferred.
//
// Times are seconds since the epoch.  All results except the changes of a ColouredState depend only
// on the arguments, so they can be computed for any frame in any order.
#pragma once

#include <array>
#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/kinect/profile.h"
#include "common/synthetic/kinect/shared_error.h"

namespace chorus::synthetic::kinect {

/// Keys of the random draws for one sensor that sees one person.
struct ErrorKeys {
  std::uint64_t seed = 1;
  std::uint64_t sensor = 0;
  std::uint64_t person = 0;
};

/// Smooth coloured noise of unit variance on three axes: white noise through two equal first-order
/// low-pass filters.  The correlation after a time L is (1 + L/a) exp(-L/a) with a = tau / 2.  One
/// filter alone would change from frame to frame enough to be taken for white noise.
class SmoothNoise {
 public:
  void advance(double passed, double tau, Draw draw);
  [[nodiscard]] Eigen::Vector3d value() const;

 private:
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d second_ = Eigen::Vector3d::Zero();
  bool started_ = false;
};

/// State of the coloured error of one person in one sensor: one process for each joint, a second
/// one for each joint while it is hidden, one common to the core joints, and the part that sensors
/// share.
struct ColouredState {
  std::array<SmoothNoise, kJointCount> joint{};
  std::array<SmoothNoise, kJointCount> hidden{};
  SmoothNoise core;
  SharedError shared;
};

/// The body's pose and motion as far as they determine the size of the error.
struct Stand {
  View view;
  double misjudged = 0.0;                   ///< Error of the yaw that the SDK shows [rad].
  double distance = 2.5;                    ///< From the sensor to the neck [m].
  std::array<double, kJointCount> speed{};  ///< Speed of each joint [m/s].
  /// How far each joint is hidden, as noticed by the SDK and indexed by its labels: 0 (seen) to 1.
  std::array<double, kJointCount> hidden{};
};

/// Smooth noise of unit variance over `time`, with correlation time `tau` [s]; a pure function.
[[nodiscard]] Eigen::Vector3d lattice_noise(std::initializer_list<std::uint64_t> key, double time,
                                            double tau);

/// The rate at which the error of a joint of this speed changes, as a share of the full rate:
/// rest_share at rest, 1 from moving_speed on.
[[nodiscard]] double activity(double speed, const ColouredError& coloured);

/// Draws the state, tracked or inferred, anew in each interval of `state_hold`.  Occluded joints
/// are mostly inferred; visible core joints, shoulders and hips never are.
[[nodiscard]] JointState shown_state(JointId id, double visible_share, double time,
                                     const Visibility& visibility, const ErrorKeys& keys);

/// The time of a frame, and the time since the one before [s].
struct Moment {
  double time = 0.0;
  double dt = 0.033;
};

/// Advances by one frame.
void advance(ColouredState& state, const Stand& stand, const Moment& moment, const Profile& profile,
             const ErrorKeys& keys);

/// Adds to every seen joint coloured and white noise, teleports, and the errors of hidden and of
/// inferred joints.
void add_errors(Skeleton<SensorSpace>& body, const ColouredState& state, const Stand& stand,
                double time, const Profile& profile, const ErrorKeys& keys);

/// The true second moment about zero of what add_errors() adds to a seen joint of this body [m^2]:
/// the covariance of the random part plus the square of its mean.
[[nodiscard]] Eigen::Matrix3d error_moment(JointId id, const Skeleton<SensorSpace>& body,
                                           const Stand& stand, double time, const Profile& profile,
                                           const ErrorKeys& keys);

}  // namespace chorus::synthetic::kinect
