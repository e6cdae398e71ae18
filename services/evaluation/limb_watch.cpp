#include "services/evaluation/limb_watch.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus::evaluation_service {

std::string_view name_of(LimbState state) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"waiting", "calibrating", "good", "off"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string words_for(const LimbJudgement& limb) {
  const std::string name =
      limb.limb ? std::string(inertial::words_for(*limb.limb)) : "sensor " + limb.sensor;
  if (limb.state == LimbState::Good && limb.slipped)
    return fmt::format("{}: the sensor has slipped by {:.0f} deg; mount it again and calibrate",
                       name, to_deg(*limb.slipped));
  if (limb.state == LimbState::Good) return name + " agrees";
  if (limb.state != LimbState::Off) return name + ": " + limb.reason;
  std::string text = fmt::format("{} off by {:.0f} deg for {:.0f} s", name, to_deg(limb.off_by),
                                 seconds(limb.off_for));
  if (limb.off_for >= kSlippedAfter)
    text += ": where the tracker is right, the sensor has slipped; mount it again and calibrate";
  return text;
}

LimbWatch::LimbWatch(const SensorId& source, const std::string& sensor,
                     std::optional<inertial::Limb> limb) {
  told_.source = source;
  told_.sensor = sensor;
  told_.limb = limb;
  told_.reason = limb ? "the tracker has not been heard yet"
                      : "its limb is not known; name it in the key \"limbs\" of its source";
}

void LimbWatch::calibrate_as(inertial::SensorCalibration calibration) {
  told_.sigma = calibration.prediction_sigma;
  told_.limb = calibration.limb;
  evaluation::LiveCalibrationOptions options;
  options.slip_lasts = seconds(kSlippedAfter);
  live_.emplace(calibration, options);
  told_.slipped.reset();
  calibration_ = std::move(calibration);
  pairs_.clear();
}

void LimbWatch::forget_calibration() {
  if (told_.state == LimbState::Off && last_judged_) come_back(*last_judged_);
  calibration_.reset();
  live_.reset();
  told_.slipped.reset();
  pairs_.clear();
  pairs_seen_ = tried_at_ = 0;
  last_pair_.reset();
  above_since_.reset();
  twist_off_at_.reset();
  told_.error.reset();
  told_.axes.reset();
  told_.sigma = 0.0;
  told_.state = LimbState::Waiting;
  told_.reason = "calibrates anew";
}

void LimbWatch::unseen(std::string reason, Timestamp at, const WatchOptions& options) {
  const bool judged = told_.state == LimbState::Good || told_.state == LimbState::Off;
  if (judged && last_judged_ && seconds(at - *last_judged_) <= options.detection.largest_gap)
    return;
  if (told_.state == LimbState::Off) come_back(*last_judged_);
  above_since_.reset();
  told_.state = LimbState::Waiting;
  told_.error.reset();
  told_.axes.reset();
  told_.reason = std::move(reason);
}

void LimbWatch::judge(const evaluation::OrientationPair& pair, Timestamp at,
                      const WatchOptions& options) {
  if (!calibration_) calibrate(pair, at, options);
  if (!live_) return;
  evaluation::OrientationPair timed = pair;
  timed.time = seconds(at.time_since_epoch());
  live_->learn(timed);
  if (live_->slip()) told_.slipped = live_->slip()->angle;
  const inertial::SensorCalibration now = live_->at(timed.time);
  told_.error = evaluation::limb_error(now, timed);
  told_.axes = {timed.tracked.world_from_limb,
                inertial::predicted_limb(now, timed.inertial_from_sensor)};
  detect(*told_.error, at, options);
  last_judged_ = at;
}

/// Collects pairs, and tries a calibration now and then.
void LimbWatch::calibrate(const evaluation::OrientationPair& pair, Timestamp at,
                          const WatchOptions& options) {
  if (told_.state != LimbState::Calibrating) {
    told_.state = LimbState::Calibrating;
    told_.reason = "calibrates: " + evaluation::movement_for(*told_.limb);
  }
  if (last_pair_ && at - *last_pair_ < options.between_pairs) return;
  last_pair_ = at;
  pairs_.push_back(pair);
  ++pairs_seen_;
  if (pairs_.size() > options.most_pairs) pairs_.erase(pairs_.begin());
  if (pairs_seen_ >= (tried_at_ == 0 ? options.first_try : tried_at_ + options.next_try))
    try_calibration(options);
}

void LimbWatch::try_calibration(const WatchOptions& options) {
  tried_at_ = pairs_seen_;
  auto fit = evaluation::calibrate_sensor(pairs_, told_.sensor, *told_.limb, options.calibrate);
  if (!fit) {
    told_.reason = "not calibrated yet: " + fit.error().message;
    return;
  }
  told_.tau = options.detection.on;
  if (options.own_tau)
    told_.tau = std::min(told_.tau,
                         evaluation::limb_tau(evaluation::error_track(fit->calibration, pairs_)));
  calibrate_as(std::move(fit->calibration));
}

/// Whether the instant is one of an error.
bool LimbWatch::counts(const evaluation::LimbError& error, Timestamp at,
                       const WatchOptions& options) const {
  const bool was_off = told_.state == LimbState::Off;
  const double limit = was_off ? told_.tau * options.detection.off_share : told_.tau;
  if (error.angle > limit) return true;
  return was_off && !error.twist_seen && twist_off_at_ && at - *twist_off_at_ <= kTwistHold;
}

void LimbWatch::detect(const evaluation::LimbError& error, Timestamp at,
                       const WatchOptions& options) {
  told_.reason.clear();
  if (!counts(error, at, options)) {
    if (told_.state == LimbState::Off) come_back(at);
    told_.state = LimbState::Good;
    above_since_.reset();
    return;
  }
  const double limit = told_.tau * options.detection.off_share;
  if (error.angle > limit) told_.off_by = error.angle;
  if (error.twist_seen && error.angle > limit) twist_off_at_ = at;
  if (!above_since_) above_since_ = at;
  if (told_.state != LimbState::Off) {
    told_.state = LimbState::Good;
    if (seconds(at - *above_since_) < options.detection.least_length) return;
    go_off(at, options);
  }
  told_.off_for = at - *above_since_;
  segments_.back().largest = std::max(segments_.back().largest, error.angle);
}

void LimbWatch::go_off(Timestamp at, const WatchOptions& options) {
  told_.state = LimbState::Off;
  ++told_.segments;
  if (segments_.size() >= std::max<std::size_t>(1, options.most_segments))
    segments_.erase(segments_.begin());
  segments_.push_back({above_since_.value_or(at), std::nullopt, 0.0});
}

void LimbWatch::come_back(Timestamp at) {
  if (!segments_.empty() && !segments_.back().ended) segments_.back().ended = at;
  told_.off_for = Duration{0};
  told_.off_by = 0.0;
  twist_off_at_.reset();
}

}  // namespace chorus::evaluation_service
