// From a walk to extrinsics (Otto 5.2.1, 5.2.3): tracks -> pairs -> graph -> Registration.
//
// Pure and deterministic.  It may take a second, so the server runs it on a worker thread.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "common/sensor/sensor_frame.h"
#include "fusion-server/flow/pairwise_registration.h"
#include "fusion-server/flow/registration.h"

namespace chorus::registration {

/// All frames of one sensor during the walk, in capture order.  Where the median of their
/// clock_sigma is 2 ms or more, the clock offset is estimated from the walk (time_offset.h).
struct WalkTrack {
  SensorId sensor;
  std::vector<SensorFrame> frames;
  /// True if the joints were directions without depth, which the walk gave (ray_depths.h).
  bool directions = false;
  std::string objection = {};  ///< Why directions could not be given a depth; a sentence.
};

enum class PairMethod {
  TimedRobust,  ///< Time-paired correspondences, closed form, robust re-weighting, ICP refinement.
  IcpOnly,      ///< Baseline: neck clouds, PCL ICP, without time (Otto 5.2.1).
};

enum class JointChoice {
  Neck,  ///< Otto: the neck alone.
  Core,  ///< Neck, SpineShoulder, Head, SpineMid, and the mid-points of shoulders, hips, elbows and
         ///< wrists, which swapped sides do not change.
  All,   ///< All joints: if sensors distinguish left and right, and for motions beyond walking.
};

/// A measured distance between two sensors.
struct KnownDistance {
  SensorId first;
  SensorId second;
  double length = 0.0;  ///< Between their origins [m].

  bool operator==(const KnownDistance&) const = default;
};

/// If all sensors guess depth, solve() replaces the limits that such sensors cannot keep
/// (suited_to() in guessed_depth.h).
struct RegistrationConfig {
  PairMethod method = PairMethod::TimedRobust;
  JointChoice joints = JointChoice::Core;
  bool use_floor = true;  ///< Pitch, roll and height from the floor plane where there is one.
  /// Ratio of the errors along and across a sensor's line of sight: 1.5-2 for a depth sensor, 5-10
  /// for a single camera that infers depth from the person's size.  If all sensors are such cameras
  /// and this is the default, 20 is used instead (guessed_depth.h).
  double along_ratio = 2.0;
  /// Longest time between two frames from which a correspondence is interpolated.
  Duration max_gap = std::chrono::milliseconds(60);
  double min_distance = 0.5;   ///< No pairs while the person is nearer to either sensor [m].
  double max_distance = 6.0;   ///< No pairs while the person is farther from either sensor [m].
  double max_speed = 2.5;      ///< No pairs while the person is faster [m/s].
  std::size_t min_pairs = 60;  ///< With fewer correspondences there is no edge.
  double min_spread = 0.25;    ///< Narrower walks are refused [m].
  double max_edge_rms = 0.15;  ///< With larger residuals there is no edge [m].
  /// One final adjustment of all sensors together.
  bool adjust_together = true;
  double good_rms = 0.08;  ///< With a larger rms of an edge the verdict is provisional [m].
  Duration good_duration = std::chrono::seconds(20);  ///< Shorter walks stay provisional.
  /// Above this 95 % radius of a sensor's place on the floor the verdict is provisional [m].
  double good_position = 0.05;
  double max_position = 0.10;  ///< With a larger radius the sensor is refused [m].
  /// Standard deviation of the coefficients of the bias of views (view_bias.h) [m].  Fitted to the
  /// errors of simulated walks (profiles A and B, seeds 101-120), by likelihood: 2.5 mm is best for
  /// sensors in pairs and rings, 3.5 mm for sensors in rows; this is in between.
  double view_bias = mm(3.0);
  /// By how much all sensors report joints too near, along the line of sight [m], because a body
  /// fitted to depth images can be too close to its visible surface.  The walk changes this value
  /// as far as its sigma [m] allows; what remains uncertain adds to the covariances.
  double depth_bias = 0.0;
  double depth_bias_sigma = 0.0;
  /// If nothing is known of the depth bias (both 0): check whether the walk shows a large one.
  bool find_large_bias = true;
  /// Lengths for sensors that guess depth from a person's size (common_scale.h); where distances
  /// are known, the stature is not used.
  std::vector<KnownDistance> known_distances = {};
  std::optional<double> stature = {};  ///< Of the person who walks [m].
  /// Standard deviation of the latencies of sensors whose clocks are known; 0: not estimated.
  Duration latency_sigma = std::chrono::milliseconds(30);
  /// Set by suited_to(): all sensors guess depth, so that none measures the floor, and what pairs
  /// of them differ by says nothing about their places.
  bool cameras_alone = false;
  std::optional<SensorId> master;  ///< Default: the sensor with the best connection to all others.

  bool operator==(const RegistrationConfig&) const = default;
};

/// Computes one edge from two tracks; an Error says in a full sentence why there is none.
[[nodiscard]] Result<PairwiseRegistration> register_pair(const WalkTrack& target,
                                                         const WalkTrack& source,
                                                         const RegistrationConfig& config);

/// Computes a registration from all tracks. The reasons say why the verdict is not Good. A sensor
/// that could not be linked is missing from `sensors`, and a reason names it ("sensors s3 and s4
/// never saw the person together").
[[nodiscard]] Registration solve(const std::vector<WalkTrack>& walk, Timestamp now,
                                 const RegistrationConfig& config);

}  // namespace chorus::registration
