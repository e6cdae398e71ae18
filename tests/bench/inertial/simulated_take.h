// A take of a simulated person who wears a simulated suit, followed by a tracker with noise.
#pragma once

#include <vector>

#include "common/evaluation/orientation_pair.h"
#include "common/evaluation/time_shift.h"
#include "common/inertial/limb.h"
#include "common/synthetic/simulated_suit.h"

namespace chorus::bench {

struct SimulatedLimb {
  inertial::Limb limb = inertial::Limb::Pelvis;
  evaluation::OrientationPairs pairs;                      ///< Tracker beside sensor.
  std::vector<Eigen::Quaterniond> truth;                   ///< world_from_limb of each pair
  std::vector<evaluation::Timed<Eigen::Vector3d>> places;  ///< Of the limb's end, tracked [m]
  std::vector<Eigen::Vector3d> true_places;  ///< The same without the tracker's error.
  evaluation::Signal acceleration;           ///< |acceleration| that the sensor measures [m/s^2]
  double length = 0.0;                       ///< Of the bone [m]
};

struct SimulatedTakePlan {
  std::uint64_t seed = 1;
  int sensors = 13;
  double length = 60.0;   ///< [s]
  double rate_hz = 40.0;  ///< Of the tracker: the paper's.
  double body_scale = 1.0;
};

/// What the tracker errs by where it is right: about each axis, coloured (0.3 s) [rad]; of joints
/// [m].
inline constexpr double kTrackerSigma = deg(5.0);
inline constexpr double kTrackerJointSigma = 0.03;

/// People walk, turn or reach for things, by seed, and exercise meanwhile.  The suit has noise of 2
/// degrees, skin as on real people, and magnetometers.
[[nodiscard]] std::vector<SimulatedLimb> simulated_take(const SimulatedTakePlan& plan);

}  // namespace chorus::bench
