// The values passed from stage to stage of the pipeline.  They are plain values: no clock, no
// socket, no lock.
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
#include "common/sensor/shares.h"
#include "common/time/clock_estimate.h"
#include "common/time/timestamp.h"

namespace chorus {

/// How a sensor's bodies at an instant were obtained.
enum class Basis {
  Exact,         ///< The sensor captured at exactly that instant.
  Interpolated,  ///< The instant is between two captures.
  Pending,       ///< A later capture may still arrive; ask again.
  /// There will be no bodies: no frames around the instant came in time, or the gap between them is
  /// too wide.
  Lost,
};

/// One sensor's bodies, moved to the common instant.
struct AlignedSensor {
  SensorId sensor;
  Basis basis = Basis::Lost;
  /// All of them have the common instant as their `captured`.  Empty unless the basis is Exact or
  /// Interpolated.
  std::vector<BodyFrame> bodies;
  std::optional<FloorPlane> floor;
};

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

/// An edge: the registration of one overlapping pair, with the direction in which it was computed;
/// code that needs the reverse inverts it explicitly.
struct PairwiseRegistration {
  SensorId target;
  SensorId source;
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  double rms = 0.0;       ///< Residual over the inliers [m].
  double icp_rms = 0.0;   ///< Residual after ICP refinement [m].
  std::size_t pairs = 0;  ///< Time-paired correspondences.
  std::size_t inliers = 0;
  double spread = 0.0;  ///< RMS distance of the walk from its centroid, along its two longest
                        ///< principal axes [m].
  /// Distance between where this pair alone and where all pairs together place a person in front of
  /// the source [m]; none: not known.
  std::optional<double> apart = {};
  /// The worst closure error of the loops that the edge forms with two other edges [m]; none: it is
  /// in no such loop.
  std::optional<double> loop = {};
  double inflation = 1.0;  ///< Number of pairs per independent pair; above 1 because pairs are
                           ///< correlated.
  /// Covariance of a small motion (omega, tau) on the target side: exp(omega), then tau [rad^2, rad
  /// m, m^2].
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

enum class Verdict { None, Provisional, Good, Refused };

/// How far one sensor's place can be trusted.
struct SensorVerdict {
  Verdict verdict = Verdict::None;   ///< Refused: the sensor has no place.
  std::vector<std::string> reasons;  ///< Human-readable: why the verdict is not Good.
};

/// The correction of one sensor's clock, as found from the walk.
struct ClockOffset {
  Duration added{0};  ///< Common clock minus the sensor's: added to its capture times.
  Duration sigma{0};  ///< Standard deviation; zero for the sensor whose clock is the common one.
  /// The SensorFrame::clock_sigma of the capture times from which the offset was found.
  Duration stated = from_seconds(kUnknownClock);
  /// The shortest time from capture, by the sensor's own stamp, to receipt during the walk; none:
  /// not known.
  std::optional<Duration> least_age = {};
};

/// Whether a host whose capture times have this clock_sigma answers with its own time.
[[nodiscard]] constexpr bool exchanges_time(double clock_sigma) {
  return clock_sigma < 0.5 * kUnknownClock;
}

/// Whether the offset holds for capture times of this clock_sigma.  It does not if the host has
/// since begun or ceased to answer with its time, or if the host's own estimate is now the better
/// one.
[[nodiscard]] inline bool holds_for(const ClockOffset& clock, double clock_sigma) {
  return exchanges_time(clock_sigma) == exchanges_time(seconds(clock.stated)) &&
         clock_sigma > seconds(clock.sigma);
}

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
};

/// One sensor's view of one person at the common instant, with everything that fusion needs to know
/// about the view.
struct SensorView {
  SensorId sensor;
  BodyId body;
  Basis basis = Basis::Exact;
  /// Distance from sensor to neck [m]; NaN: unknown.
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
  /// Probability that left and right are not swapped; none if the sides were not resolved.
  std::optional<double> sides_confidence = {};
  /// Where the middle of the person is expected, world [m].  Set only if no sensor sees the person;
  /// then there are no views.
  std::optional<Eigen::Vector3d> carried = {};
};

/// How a joint moves at the instant, according to the method's filter; all errors are alike on
/// every axis.
struct JointMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  double variance = 0.0;                               ///< Of the velocity, per axis [m^2/s^2].
  double shared = 0.0;  ///< Covariance of position and velocity, per axis [m^2/s].
  /// Spectral density of the white-noise acceleration, now and in the long run [m^2/s^3].
  double density = 0.0;
  double usual_density = 0.0;
};

struct FusedBody {
  PersonId id;
  Skeleton<WorldSpace> skeleton;
  std::array<double, kJointCount> variance{};  ///< Mean per-axis variance [m^2].
  /// Bit i: Snapshot::sensors[i] contributed.
  std::array<std::uint64_t, kJointCount> contributors{};
  std::array<Shares, kJointCount> shares{};  ///< Of Snapshot::sensors[i], at that index.
  /// Time since a sensor last contributed to the joint [s]: 0 where one does now, more where the
  /// joint is only expected.
  std::array<double, kJointCount> age{};
  std::optional<std::size_t> slot;  ///< The person's slot in every output; none: no slot.
  std::optional<double> sides_confidence = {};  ///< Copied from Person.
  /// For how long no sensor has seen the person [s]; meanwhile they are where they are expected.
  /// None while they are seen.
  std::optional<double> carried_for = {};
  /// For predictions (fusion/prediction.h); none: the method has no velocities.
  std::optional<std::array<JointMotion, kJointCount>> motion = {};
};

/// The state of one sensor at this instant, for /sensors/ and the viewer.
struct SensorReport {
  SensorId sensor;
  Basis basis = Basis::Lost;
  std::size_t bodies = 0;
  double weight = 0.0;  ///< Largest weight of the sensor's views.
};

/// All fused bodies at one instant.  Immutable once published.
struct Snapshot {
  std::uint64_t sequence = 0;
  Timestamp instant;
  std::vector<SensorId> sensors;  ///< Registered sensors ordered by id; at most 64.
  std::vector<FusedBody> bodies;
  std::vector<SensorReport> reports;
};

}  // namespace chorus
