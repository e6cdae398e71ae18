// Inertial sensors that people wore while recordings were made, read along with the frames.
//
// What the server does with live sources (worn/wear.h) is done here with recorded ones: who wears
// which, how each sensor sits, what that says at an instant.  So the first seconds of a recording
// have no help from them, unless a first pass has found how they sit (worn/beginning.h).
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/inertial/inertial_frame.h"
#include "fusion-server/worn/first_pass.h"
#include "fusion-server/worn/wear.h"

namespace chorus::pipeline {

/// One recording: the instants of its inertial sources in the order in which they were recorded, by
/// the clock of the frames.
struct InertialLane {
  std::string name;  ///< For messages.
  /// The next instant of any of the lane's sources; none at the end.
  std::function<Result<std::optional<inertial::InertialFrame>>()> next;
};

class RecordedSuits {
 public:
  /// Reads nothing unless `config` is enabled.
  RecordedSuits(std::vector<InertialLane> lanes, const worn::WornConfig& config,
                const std::vector<worn::Beginning>& beginnings = {});

  /// Reads until every lane has passed `instant` by a second, or has ended.
  [[nodiscard]] Result<void> read_to(Timestamp instant);
  [[nodiscard]] WornPeople say(Timestamp instant) const { return wear_.say(instant); }
  void learn(const std::vector<FusedBody>& bodies, Timestamp instant) {
    wear_.learn(bodies, instant);
    if (config_.enabled) pass_.note(wear_, bodies, instant);
  }
  /// What a second pass may begin with.
  [[nodiscard]] const worn::FirstPass& first_pass() const { return pass_; }
  [[nodiscard]] std::vector<WornReport> reports(Timestamp now) const { return wear_.reports(now); }

 private:
  struct Lane {
    InertialLane from;
    Timestamp newest = Timestamp::min();
    bool ended = false;
  };
  void take(inertial::InertialFrame frame);

  worn::WornConfig config_;
  std::vector<Lane> lanes_;
  std::set<SensorId> sources_;
  worn::Wear wear_;
  worn::FirstPass pass_;
};

}  // namespace chorus::pipeline
