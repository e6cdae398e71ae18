// Real cameras with Vicon, and inertial sensors that stand in for real ones: Vicon's orientations
// times the errors that real sensors had against Vicon in another take.  No public set has both.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/importers/formats.h"
#include "common/inertial/inertial_frame.h"
#include "fusion-server/flow/person.h"
#include "fusion-server/flow/snapshot.h"
#include "fusion-server/fusion/fuse.h"
#include "fusion-server/worn/wear.h"

namespace chorus::bench {

inline constexpr double kTakeHz = 30.0;       // of pictures [Hz]
inline constexpr double kSensorHz = 60.0;     // of the sensors [Hz]
inline constexpr double kLearnedPart = 0.35;  // of a take that is not judged

/// One sensor's orientations, world_from_limb with the error of a real sensor, at kSensorHz.
struct StandIn {
  inertial::Limb limb = inertial::Limb::Pelvis;
  std::vector<Eigen::Quaterniond> world_from_limb;
};

struct WornTake {
  std::string name;
  importers::ImportedSet rays;
  std::vector<StandIn> sensors;

  [[nodiscard]] std::size_t size() const { return rays.truth.size(); }
  [[nodiscard]] std::size_t judged_from() const {
    return static_cast<std::size_t>(kLearnedPart * static_cast<double>(size()));
  }
};

/// The takes of $CHORUS_EIGHT_VIEWS that have gt_skel_gbl_ori.txt beside their cameras; the errors
/// are those of $CHORUS_XSENS13.  Empty where either is not there.
[[nodiscard]] Result<std::vector<WornTake>> worn_takes();

/// How the sensors of a trial are wrong.
struct SensorFaults {
  std::uint64_t seed = 1;  ///< Of mounts and headings.
  double drift = 0.0;      ///< Of all headings [rad/s].
  std::optional<inertial::Limb> slips = {};
  double slips_at = 0.0;  ///< [s]
  double slip = 0.0;      ///< [rad]
};

inline constexpr std::string_view kStandInSuit = "suit";

/// What the sensors say at sample `index`, 60 a second.
[[nodiscard]] inertial::InertialFrame said(const WornTake& take, const SensorFaults& faults,
                                           std::size_t index);
/// The heading of a sensor with these faults at `time` [s], world_from_inertial [rad].
[[nodiscard]] double true_heading(const SensorFaults& faults, std::size_t sensor, double time);

/// Whether joint `id` is hidden at instant `index`.
using Hides = std::function<bool(JointId id, std::size_t index)>;

/// An instant of a take as fusion gets it.
struct SeenInstant {
  Timestamp at;
  std::vector<SensorId> sensors;
  std::vector<Person> people;
};

/// What these cameras (indexes into the recordings) show, associated by the pipeline as shipped;
/// one entry for each instant of the truth.
[[nodiscard]] Result<std::vector<SeenInstant>> seen_by(const WornTake& take,
                                                       const std::vector<std::size_t>& cameras,
                                                       const Hides& hides = {});

/// What was fused, one entry for each instant; none where there was nobody.
struct FusedTake {
  std::vector<std::optional<FusedBody>> bodies;
  worn::Wear wear;
  std::optional<double> told;  ///< When a slip was first told [s].
  double seconds_fusing = 0.0;
  double seconds_wearing = 0.0;  ///< In Wear.
};

/// By the estimator as shipped; null `faults`: without sensors.  `each` is called after an instant.
using AfterInstant = std::function<void(std::size_t index, const worn::Wear& wear)>;
[[nodiscard]] FusedTake fused_with(const WornTake& take, const std::vector<SeenInstant>& seen,
                                   const SensorFaults* faults, const AfterInstant& each = {});
/// By the body filter alone, which carries hidden joints for a second.
[[nodiscard]] FusedTake fused_by_body_filter(const std::vector<SeenInstant>& seen);

}  // namespace chorus::bench
