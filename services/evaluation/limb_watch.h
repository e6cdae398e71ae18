// One sensor on one limb, live: its calibration from the first seconds, then the error of each
// instant and whether it counts as a tracking error.
//
// The error is that of Eq. (13) of Baak et al. (evaluation/limb_error.h).  It counts while it is
// above tau, with hysteresis, once it has lasted for the least length.  An instant at which the
// tracker shows no twist does not end an error of twist, for up to kTwistHold.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "common/evaluation/calibrate.h"
#include "common/evaluation/limb_error.h"
#include "common/evaluation/live_calibration.h"
#include "common/inertial/limb.h"
#include "common/time/timestamp.h"

namespace chorus::evaluation_service {

enum class LimbState : std::uint8_t {
  Waiting,      ///< The tracker does not see the limb, or nobody wears the sensor.
  Calibrating,  ///< There is no calibration yet.
  Good,
  Off,  ///< Tracker and sensor disagree.
};
/// "waiting", "calibrating", "good", "off".
[[nodiscard]] std::string_view name_of(LimbState state) noexcept;

/// How a limb is turned at one instant, in the tracker's space (limb axes: limb_frame.h).
struct LimbAxes {
  Eigen::Quaterniond tracked;    ///< world_from_limb as the tracker has it.
  Eigen::Quaterniond predicted;  ///< As the sensor on it has it, by its calibration.
};

struct LimbJudgement {
  SensorId source;
  std::string sensor;
  std::optional<inertial::Limb> limb;  ///< None: not known; such a sensor waits.
  std::optional<PersonId> person;
  LimbState state = LimbState::Waiting;
  std::string reason;                          ///< Why it is not judged yet; for people.
  std::optional<evaluation::LimbError> error;  ///< At the last instant that was judged.
  std::optional<LimbAxes> axes;                ///< Of that instant.
  double off_by = 0.0;                         ///< The angle when it was above the limit last [rad]
  double sigma = 0.0;                          ///< Standard error of the calibration [rad].
  double tau = evaluation::kPaperTau;          ///< [rad]
  Duration off_for{0};                         ///< For how long it has been off, while it is.
  std::uint64_t segments = 0;                  ///< How often it has been off since the start.
  /// By how much the sensor has turned on its limb since it was calibrated [rad], once that lasts
  /// for kSlippedAfter; also where that is below tau.
  std::optional<double> slipped = {};
};

/// "left forearm off by 70 deg for 4 s"; the reason if it is not judged.
[[nodiscard]] std::string words_for(const LimbJudgement& limb);

/// Tracking errors of real trackers last seconds; a limb that is off without a break for longer
/// than this has probably a sensor that was moved on it.
inline constexpr Duration kSlippedAfter = std::chrono::seconds(10);
/// A walking knee is bent enough to show twist about once a second.
inline constexpr Duration kTwistHold = std::chrono::seconds(2);

/// A tracking error as it happened; times by our clock.
struct ErrorSegment {
  Timestamp began;
  std::optional<Timestamp> ended;  ///< None: it goes on.
  double largest = 0.0;            ///< [rad]
};

struct WatchOptions {
  evaluation::DetectionOptions detection;
  bool own_tau = false;  ///< A limb's own tau, from its calibration, where that is smaller.
  evaluation::CalibrateOptions calibrate;
  Duration between_pairs = std::chrono::milliseconds(100);  ///< For the calibration.
  std::size_t first_try = 50;  ///< Pairs before a calibration is tried,
  std::size_t next_try = 20;   ///< and more pairs before it is tried again.
  std::size_t most_pairs = 400;
  std::size_t most_segments = 200;  ///< That are remembered of a limb.
};

class LimbWatch {
 public:
  LimbWatch() = default;
  LimbWatch(const SensorId& source, const std::string& sensor, std::optional<inertial::Limb> limb);

  /// One instant at which both sides know the limb.
  void judge(const evaluation::OrientationPair& pair, Timestamp at, const WatchOptions& options);
  /// An instant at which they do not, and why.  A short gap ends no error.
  void unseen(std::string reason, Timestamp at, const WatchOptions& options);

  void worn_by(PersonId person) { told_.person = person; }
  void calibrate_as(inertial::SensorCalibration calibration);
  /// Begins anew: the sensor was moved.
  void forget_calibration();

  [[nodiscard]] const LimbJudgement& told() const { return told_; }
  /// As it was found, or given; what is judged with follows drifting headings, too.
  [[nodiscard]] const std::optional<inertial::SensorCalibration>& calibration() const {
    return calibration_;
  }
  /// Oldest first.
  [[nodiscard]] const std::vector<ErrorSegment>& segments() const { return segments_; }

 private:
  void calibrate(const evaluation::OrientationPair& pair, Timestamp at,
                 const WatchOptions& options);
  void try_calibration(const WatchOptions& options);
  void detect(const evaluation::LimbError& error, Timestamp at, const WatchOptions& options);
  void go_off(Timestamp at, const WatchOptions& options);
  void come_back(Timestamp at);
  [[nodiscard]] bool counts(const evaluation::LimbError& error, Timestamp at,
                            const WatchOptions& options) const;

  LimbJudgement told_;
  evaluation::OrientationPairs pairs_;
  std::optional<Timestamp> last_pair_;
  std::size_t tried_at_ = 0;  ///< Number of pairs so far when a calibration was last tried.
  std::size_t pairs_seen_ = 0;
  std::optional<inertial::SensorCalibration> calibration_;
  std::optional<evaluation::LiveCalibration> live_;  ///< Of calibration_.
  std::optional<Timestamp> above_since_;
  std::optional<Timestamp> last_judged_;
  std::optional<Timestamp> twist_off_at_;  ///< When a twist was last seen that was off.
  std::vector<ErrorSegment> segments_;
};

}  // namespace chorus::evaluation_service
