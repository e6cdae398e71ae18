// Corrects the capture times of frames by the clock offsets that a walk has determined.
//
// A walk shows by how much each clock was off during the walk. A host that does not answer with its
// time may drift by tens of milliseconds an hour, or its clock may be set: then every frame arrives
// earlier or later after its stamp than during the walk. So the least age of recent frames, from
// stamp to receipt, is followed: the fastest frames have only the constant delay, which the walk
// has measured along with the offset.
#pragma once

#include <deque>
#include <map>
#include <optional>

#include "fusion-server/flow.h"

namespace chorus::core {

/// The least of a sensor's recent ages, from capture by its own stamps to receipt.  A frame that is
/// younger than all before it by more than jitter counts only if it is the third in a row.  If all
/// ages grow by more than a link would delay frames for seconds, because the clock was set back,
/// this is believed after three seconds; if they grow less, only after the whole window.
class LeastAge {
 public:
  void add(Timestamp received, Duration age);
  /// None until frames have once come for three seconds without a pause of more than one.
  [[nodiscard]] std::optional<Duration> value() const;

 private:
  struct Entry {
    Timestamp received;
    Duration age;
  };
  void forget_until(Timestamp received);

  std::deque<Entry> entries_;  ///< Ages increase from front to back, so the first is the least.
  std::optional<Timestamp> last_;
  Timestamp since_;  ///< The start of the present series of frames without a pause.
  bool settled_ = false;
  int younger_ = 0;  ///< Number of frames in a row that are younger than all before.
};

/// What is added to one sensor's capture times.
struct WalkedClock {
  Duration added{0};
  Duration sigma{0};

  bool operator==(const WalkedClock&) const = default;
};

class WalkedClocks {
 public:
  /// Takes a frame as the poller gives it; returns by how much the correction of this sensor's
  /// capture times has changed.  Frames that were corrected before have to be moved by this
  /// difference.
  Duration take(const SensorFrame& frame, const Registration& registration);

  /// None: nothing is added to this sensor's capture times.
  [[nodiscard]] std::optional<WalkedClock> of(const SensorId& sensor) const;
  /// Forgets sensors that are no longer configured.
  template <class Sensors>
  void keep(const Sensors& sensors) {
    std::erase_if(states_, [&](const auto& entry) { return !sensors.contains(entry.first); });
  }

 private:
  struct State {
    LeastAge least;
    std::optional<WalkedClock> applied;
  };

  std::map<SensorId, State> states_;
};

}  // namespace chorus::core
