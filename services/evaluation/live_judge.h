// Judges a tracker live: what the sensors on a person's limbs say against what the tracker says.
//
// Each instant of the tracker is judged once the sensors have caught up with it (limb_watch.h).
// Who of several people wears the suit: the only one in sight, whoever wore it before, or the one
// whose limbs the sensors fit (wearer_search.h).  Pure: no clock, no thread.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/body/skeleton.h"
#include "common/inertial/calibration.h"
#include "common/inertial/orientation_history.h"
#include "services/evaluation/limb_watch.h"
#include "services/evaluation/wearer_search.h"

namespace chorus::evaluation_service {

/// The people of one instant of the tracker; times by our clock.
struct TrackedInstant {
  Timestamp captured;
  std::vector<std::pair<PersonId, Skeleton<WorldSpace>>> people;
};

struct JudgeOptions {
  WatchOptions watch;
  bool stated = false;  ///< The orientations that the tracker states, instead of its joints.
  /// By source: the limb of each sensor whose name does not say it.
  std::map<SensorId, std::map<std::string, inertial::Limb>> limbs = {};
  /// How the sensors sit, where it is known from another take; the others calibrate themselves.
  std::vector<inertial::InertialCalibration> calibrations = {};
};

/// One tracking error, of which limb.
struct LimbSegment {
  SensorId source;
  std::string sensor;
  inertial::Limb limb = inertial::Limb::Pelvis;
  std::optional<PersonId> person;
  ErrorSegment segment;
};

class LiveJudge {
 public:
  explicit LiveJudge(JudgeOptions options = {}) : options_(std::move(options)) {}

  void take(inertial::InertialFrame instant);
  void take(TrackedInstant instant);

  /// Judges the instants of the tracker that the sensors have caught up with; returns the time of
  /// the last one, none if there was none.
  std::optional<Timestamp> judge();

  /// One for each sensor, ordered by source and name.
  [[nodiscard]] std::vector<LimbJudgement> limbs() const;
  /// The errors since the start, by the time at which they began.
  [[nodiscard]] std::vector<LimbSegment> segments() const;
  /// The sources that were heard.
  [[nodiscard]] std::vector<SensorId> sources() const;
  /// What is known of how the sensors of a source sit; NotFound if none is calibrated.
  [[nodiscard]] Result<inertial::InertialCalibration> calibration(const SensorId& source) const;
  /// All sensors of the source calibrate anew.  NotFound if it was not heard.
  Result<void> forget_calibration(const SensorId& source);

 private:
  using Suit = std::map<std::string, LimbWatch, std::less<>>;
  struct Source {
    Suit suit;
    /// Judging looks at the last second.
    inertial::OrientationHistory history{{.span = std::chrono::milliseconds(2500)}};
    std::optional<Timestamp> newest;
    std::optional<PersonId> wearer;
    WearerSearch search;
  };

  void know(const SensorId& id, Source& source, const inertial::InertialReading& reading);
  [[nodiscard]] std::optional<inertial::Limb> limb_of(
      const SensorId& source, const inertial::InertialReading& reading) const;
  [[nodiscard]] std::optional<evaluation::TrackedOrientation> tracked_limb(
      const Skeleton<WorldSpace>& body, inertial::Limb limb) const;
  void find_wearer(Source& source, const TrackedInstant& instant,
                   const std::vector<inertial::InertialReading>& readings) const;
  void judge_source(Source& source, const TrackedInstant& instant);
  void judge_limb(LimbWatch& limb, const Skeleton<WorldSpace>& body,
                  const inertial::InertialReading* reading, Timestamp at) const;

  JudgeOptions options_;
  std::map<SensorId, Source> sources_;
  std::deque<TrackedInstant> waiting_;
  std::optional<Timestamp> origin_;  ///< Of the times of pairs.
};

}  // namespace chorus::evaluation_service
