// Otto's experiments with a mannequin on a robot arm (Sect. 3), in front of a simulated sensor.
#pragma once

#include <array>
#include <vector>

#include "common/body/skeleton.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::bench {

/// One frame of an experiment.
struct MannequinSample {
  double angle = 0.0;  ///< True yaw of the mannequin away from facing the sensor [rad]
  Skeleton<SensorSpace> shown;
  Skeleton<SensorSpace> exact;
};

/// Turns by 360 deg about the mannequin's own vertical axis, at 2.3 m, before a level sensor at a
/// height of 1 m (Fig. 4A).
[[nodiscard]] std::vector<MannequinSample> turn_full(const synthetic::kinect::Profile& profile,
                                                     std::uint64_t seed);

/// Swings by 85 deg about a vertical axis behind the mannequin's back, so that the body travels on
/// a circle (Fig. 4B).
[[nodiscard]] std::vector<MannequinSample> swing_85(const synthetic::kinect::Profile& profile,
                                                    std::uint64_t seed);

/// Mean displacement [m] of one joint from frame to frame while the true yaw is between the two
/// angles [rad] (Otto Fig. 7).  Computed from second differences, so that the slow turn does not
/// count.
[[nodiscard]] double jitter(const std::vector<MannequinSample>& samples, JointId joint,
                            double least_angle, double most_angle);

/// Yaw shown by the shoulders, 0 = facing the sensor [rad].
[[nodiscard]] double shown_facing(const Skeleton<SensorSpace>& body);

}  // namespace chorus::bench
