// Where the sensors stand, and how far that can be trusted.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "common/time/timestamp.h"
#include "fusion-server/flow/clock_offset.h"
#include "fusion-server/flow/latency.h"
#include "fusion-server/flow/pairwise_registration.h"

namespace chorus {

/// The pose of a sensor: x_in_world = world_from_sensor * x_in_sensor.
struct Extrinsics {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  std::vector<SensorId> chain;  ///< Master first, this sensor last (Otto 5.2.3).
  double error = 0.0;           ///< Sum of the edge errors along the chain [m].
  /// The best chain whose last edge is another one, and its error; they show why `chain` was
  /// chosen.
  std::vector<SensorId> next_chain = {};
  double next_error = 0.0;
  /// Covariance of (rotation vector, sensor position) in world axes, relative to the master [rad^2,
  /// rad m, m^2].
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// What the sensor's points are multiplied by, about its origin, before they are placed: not 1
  /// for a camera that guesses depth from a person's size, once a length is known.
  double scale = 1.0;
};

/// Covariances of the places of several sensors with each other: six rows for each, as
/// Extrinsics::covariance.
struct JointCovariance {
  std::vector<SensorId> sensors;
  Eigen::MatrixXd matrix;
};

enum class Verdict { None, Provisional, Good, Refused };

/// How far one sensor's place can be trusted.
struct SensorVerdict {
  Verdict verdict = Verdict::None;   ///< Refused: the sensor has no place.
  std::vector<std::string> reasons;  ///< Human-readable: why the verdict is not Good.
  /// The place is used only once somebody has accepted it (registration/ray_places.h).  Of the
  /// result of a walk; not stored.
  bool unconfirmed = false;
};

/// By how much all sensors report joints too near, along their lines of sight, as a walk says.
struct WalkedDepthBias {
  double bias = 0.0;   ///< [m]
  double sigma = 0.0;  ///< [m]
};

/// Where sensors stood when people began to rely on the world (world_from_sensor).
using Anchors = std::map<SensorId, Eigen::Isometry3d>;

/// The places of all sensors.  It is replaced as a whole, stored, and has a version.
struct Registration {
  std::uint64_t version = 0;
  Timestamp solved;
  /// The verdict on all sensors that have a place, taken together.
  Verdict verdict = Verdict::None;
  std::vector<std::string> reasons;  ///< Why the verdict is not Good, and why sensors are missing.
  SensorId master;
  std::map<SensorId, Extrinsics> sensors;
  /// One for each sensor that took part in a walk, whether it has a place or not.
  std::map<SensorId, SensorVerdict> verdicts;
  std::vector<PairwiseRegistration> edges;
  /// Offsets found from the walk because the clock of some sensor was not known; empty if all were
  /// known.
  std::map<SensorId, ClockOffset> clocks = {};
  /// What later registrations are moved to, so that their errors do not add up (core/world.h).  A
  /// sensor that is not in it is anchored where it stands.
  Anchors anchors = {};
  /// Of the sensors whose clocks are known, as far as the walk tells.
  Latencies latencies = {};
  /// Only when the walk was asked for it (registration.depth_bias_sigma_m), or shows a large one;
  /// not stored.
  std::optional<WalkedDepthBias> depth_bias = {};
  /// Only while cameras are being registered, until their scale is known (common_scale.h).
  std::optional<JointCovariance> together = {};
};

/// What is added to the capture times of this sensor, whose frames state this clock_sigma, because
/// of what the walk told of its clock and its latency.
[[nodiscard]] inline Duration walked_correction(const Registration& registration,
                                                const SensorId& sensor, double clock_sigma) {
  Duration added{0};
  const auto clock = registration.clocks.find(sensor);
  if (clock != registration.clocks.end() && holds_for(clock->second, clock_sigma))
    added += clock->second.added;
  const auto latency = registration.latencies.find(sensor);
  if (latency != registration.latencies.end()) added += latency->second.added();
  return added;
}

}  // namespace chorus
