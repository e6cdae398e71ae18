// Corrects the capture times of a sensor's frames by the clock offset and latency that a walk has
// determined.
//
// A walk shows by how much each clock was off during the walk. A host that does not answer with its
// time may drift by tens of milliseconds an hour, or its clock may be set: then every frame arrives
// earlier or later after its stamp than during the walk. So the least age of recent frames, from
// stamp to receipt, is followed: the fastest frames have only the constant delay, which the walk
// has measured along with the offset.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/sensor/sensor_frame.h"
#include "fusion-server/flow/clock_offset.h"
#include "fusion-server/flow/registration.h"

namespace chorus::core {

/// The least of a sensor's recent ages, from capture by its own stamps to receipt.  A frame that is
/// younger than all before it by more than jitter counts only if the next two are, too.  All ages
/// grow if the clock was set back, but also if the link has become slower.  A clock that was set
/// back is believed after three seconds, but only if stamps went back, or if there was a pause in
/// which they may have.  Otherwise the value grows only after 40 s, when the frames of lesser age
/// have left the window.  After a pause it stays as it was until frames have come for three
/// seconds, because the first ones may have been held back.
class LeastAge {
 public:
  void add(Timestamp received, Duration age);
  /// None until frames have come for three seconds once, with no pause of more than a second.
  [[nodiscard]] std::optional<Duration> value() const { return value_; }

 private:
  struct Entry {
    Timestamp received;
    Duration age;
  };
  void forget_until(Timestamp received);
  void note_stamp(Timestamp received, Timestamp stamp);

  std::deque<Entry> entries_;  ///< Ages increase from front to back, so the first is the least.
  std::optional<Timestamp> last_;
  Timestamp since_;  ///< Received without a pause since then.
  std::optional<Duration> value_;
  int younger_ = 0;  ///< Frames in a row that are younger than all before.
  Timestamp newest_stamp_;
  int back_ = 0;         ///< Frames in a row whose stamps are before the newest one.
  Timestamp went_back_;  ///< Receipt of the last frame that showed that stamps went back.
};

/// What is added to one sensor's capture times.
struct WalkedClock {
  Duration added{0};
  Duration sigma{0};

  bool operator==(const WalkedClock&) const = default;
};

class ClockCorrection {
 public:
  /// Takes a frame of the sensor as the poller gives it; returns by how much the correction of its
  /// capture times has changed.  Frames that were corrected before have to be moved by this
  /// difference.
  Duration take(const SensorFrame& frame, const Registration& registration);

  /// None: no clock offset is added to the sensor's capture times.
  [[nodiscard]] const std::optional<WalkedClock>& walked() const noexcept { return applied_; }
  /// What is added to them: the clock offset, and what takes off the sensor's latency.
  [[nodiscard]] Duration added() const {
    return latency_ + (applied_ ? applied_->added : Duration{0});
  }

 private:
  void follow_clock(const SensorFrame& frame, const Registration& registration);
  [[nodiscard]] bool holds(const ClockOffset& clock, const SensorFrame& frame,
                           const Registration& registration);

  LeastAge least_;
  std::optional<WalkedClock> applied_;
  Duration latency_{0};  ///< Added because of the sensor's latency.
  /// Version of the registration whose offset is no longer added because the host's own estimate
  /// has become better.
  std::optional<std::uint64_t> outdone_by_;
};

}  // namespace chorus::core
