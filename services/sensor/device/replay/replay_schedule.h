// Computes when each frame of a recording is due again; has no clock and no thread.
//
//   due = epoch + ((recorded - origin) + loop * period) / speed
//
// All recordings of a set share `origin` and `period` (first capture and length of the whole set),
// so that replays with the same epoch in several processes stay in step, round after round.  `loop`
// counts the rounds.
#pragma once

#include <cstdint>

#include "common/base/result.h"
#include "services/sensor/device/replay/replay_tape.h"

namespace chorus::sensor_service {

struct ReplayTiming {
  Timestamp epoch;   ///< When the instant `origin` is played.
  Timestamp origin;  ///< First capture of the set.
  Duration period;   ///< Length of the set, which is that of one round.
  double speed = 1.0;
  bool loop = true;
};

/// One frame of the recording in one round of playing.
struct Turn {
  Timestamp captured;
  std::uint64_t number = 0;  ///< Within the recording, from 0.
  std::int64_t round = 0;

  auto operator<=>(const Turn&) const = default;
};

class ReplaySchedule {
 public:
  /// Refuses an empty recording, a speed that is not positive or is too high, and an origin or a
  /// period that does not fit the recording.
  [[nodiscard]] static Result<ReplaySchedule> make(const TapeSpan& span,
                                                   const ReplayTiming& timing);

  [[nodiscard]] Timestamp due(const Turn& turn) const;
  /// A round that contains the first frame due at or after `now`, or the round before that one.
  [[nodiscard]] std::int64_t round_before(Timestamp now) const;
  [[nodiscard]] bool over(std::int64_t round) const;
  /// Number of the frame since the epoch, from 1; a gap means frames that were not played.
  [[nodiscard]] std::uint64_t sequence(const Turn& turn) const;

 private:
  ReplaySchedule(const TapeSpan& span, const ReplayTiming& timing) : span_(span), timing_(timing) {}

  TapeSpan span_;
  ReplayTiming timing_;
};

/// The length of one round if nothing states it: from first to last capture, plus the usual step.
[[nodiscard]] inline Duration natural_period(const TapeSpan& span) {
  return span.last - span.first + span.step;
}

}  // namespace chorus::sensor_service
