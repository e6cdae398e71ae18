// The values handed from stage to stage of the pipeline.  Values only: no clock, no socket, no
// lock.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "common/body/body_frame.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/timestamp.h"

namespace chorus {

/// How the answer for an instant was obtained.
enum class Basis {
  Exact,         ///< A capture at that very instant.
  Interpolated,  ///< Between two captures.
  Pending,       ///< Not yet: a later capture may still arrive.  Ask again.
  Lost,  ///< Never: the sensor passed the instant without seeing it, or the gap is too wide.
};

/// One sensor's bodies, moved to the common instant.
struct AlignedSensor {
  SensorId sensor;
  Basis basis = Basis::Lost;
  /// `captured` is the common instant; empty unless Exact/Interpolated.
  std::vector<BodyFrame> bodies;
  std::optional<FloorPlane> floor;
};

/// Where a sensor stands: points x_in_world = world_from_sensor * x_in_sensor.
struct Extrinsics {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  std::vector<SensorId> chain;  ///< Master first, this sensor last (Otto 5.2.3).
  double error = 0.0;           ///< Summed edge error along the chain [m].
  /// Of (rotation vector, sensor position) in world axes, relative to the master [rad^2, rad m,
  /// m^2].
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// One overlapping pair: the client as seen from the master's side.  An edge; never silently
/// inverted.
struct PairwiseRegistration {
  SensorId target;
  SensorId source;
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  double rms = 0.0;       ///< Residual over the inliers [m].
  double icp_rms = 0.0;   ///< Residual after ICP refinement [m].
  std::size_t pairs = 0;  ///< Time-paired correspondences.
  std::size_t inliers = 0;
  double spread = 0.0;     ///< rms radius of the walk about its centroid, horizontally [m].
  double inflation = 1.0;  ///< Pairs per independent pair.
  /// Of a small motion exp(omega), tau applied on the target side [rad^2, rad m, m^2].
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

enum class Verdict { None, Provisional, Good, Refused };

/// How far one sensor's place may be trusted.
struct SensorVerdict {
  Verdict verdict = Verdict::None;   ///< Refused: it has no place.
  std::vector<std::string> reasons;  ///< Why not good, one sentence for people each.
};

/// The sensors' places, replaced whole, persisted, versioned.
struct Registration {
  std::uint64_t version = 0;
  Timestamp solved;
  Verdict verdict = Verdict::None;   ///< Of the sensors that have a place, together.
  std::vector<std::string> reasons;  ///< Why not good, and why sensors are missing.
  SensorId master;
  std::map<SensorId, Extrinsics> sensors;
  /// For each sensor that took part in a walk, with a place or without.
  std::map<SensorId, SensorVerdict> verdicts;
  std::vector<PairwiseRegistration> edges;
};

/// One sensor's sight of one person at the common instant, with everything that fusion needs to
/// know about it.
struct SensorView {
  SensorId sensor;
  BodyId body;
  Basis basis = Basis::Exact;
  /// Sensor to neck [m]; NaN: unknown.
  double distance = std::numeric_limits<double>::quiet_NaN();
  double facing = std::numeric_limits<double>::quiet_NaN();   ///< Otto Eq. (2) phi [rad].
  double bearing = std::numeric_limits<double>::quiet_NaN();  ///< Otto Eq. (3) alpha [rad].
  double weight = 0.0;                            ///< Product of Eqs. (1)-(3), in [0, 1].
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Sensor position in world [m].
  Skeleton<WorldSpace> skeleton;
};

/// All views of one person at one instant.
struct Person {
  PersonId id;
  std::vector<SensorView> views;
  /// Probability that left and right are not exchanged; none: nobody has asked.
  std::optional<double> sides_confidence = {};
};

struct FusedBody {
  PersonId id;
  Skeleton<WorldSpace> skeleton;
  std::array<double, kJointCount> variance{};             ///< Mean per-axis variance [m^2].
  std::array<std::uint64_t, kJointCount> contributors{};  ///< Bit i: Snapshot::sensors[i].
  std::optional<std::size_t> slot;              ///< Its number in every output; none: not seated.
  std::optional<double> sides_confidence = {};  ///< As Person has it.
};

/// What one sensor did at this instant, for /sensors/ and the viewer.
struct SensorReport {
  SensorId sensor;
  Basis basis = Basis::Lost;
  std::size_t bodies = 0;
  double weight = 0.0;  ///< Largest view weight of its bodies.
};

/// All fused bodies at one instant.  Immutable once published.
struct Snapshot {
  std::uint64_t sequence = 0;
  Timestamp instant;
  std::vector<SensorId> sensors;  ///< Registered sensors in id order; at most 64.
  std::vector<FusedBody> bodies;
  std::vector<SensorReport> reports;
};

}  // namespace chorus
