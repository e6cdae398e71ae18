// When each frame of a recording is due again.  Pure: no clock, no thread.
//
//   due = epoch + ((recorded - origin) + loop * period) / speed
//
// `origin` and `period` are shared by all recordings of a set (the first capture and the length
// over all of them), so that replays in several processes with one epoch stay in step, loop after
// loop.
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/result.h"
#include "common/time/timestamp.h"

namespace chorus::sensor_service {

struct ReplayTiming {
  Timestamp epoch;   ///< When `origin` happens again.
  Timestamp origin;  ///< First capture of the set.
  Duration period;   ///< Length of the set; one loop.
  double speed = 1.0;
  bool loop = true;
};

/// One frame's turn: which frame of the recording, in which round.
struct Turn {
  std::size_t frame = 0;
  std::int64_t round = 0;

  auto operator<=>(const Turn&) const = default;
};

class ReplaySchedule {
 public:
  /// `captured`: strictly increasing.  Refuses an empty recording, a speed that is not positive,
  /// and a period that does not cover the recording.
  [[nodiscard]] static Result<ReplaySchedule> make(std::vector<Timestamp> captured,
                                                   const ReplayTiming& timing);

  [[nodiscard]] Timestamp due(const Turn& turn) const;
  /// The first turn that is not due before `now`; past the last frame when nothing is left to play.
  [[nodiscard]] Turn first_from(Timestamp now) const;
  [[nodiscard]] Turn after(const Turn& turn) const;
  [[nodiscard]] bool over(const Turn& turn) const;
  /// Counts frames from the epoch on, from 1; gaps are frames that were not played.
  [[nodiscard]] std::uint64_t sequence(const Turn& turn) const;

 private:
  ReplaySchedule(std::vector<Timestamp> captured, const ReplayTiming& timing)
      : captured_(std::move(captured)), timing_(timing) {}

  std::vector<Timestamp> captured_;
  ReplayTiming timing_;
};

/// The length of one loop when nobody states it: first to last capture and one median step more.
[[nodiscard]] Duration natural_period(const std::vector<Timestamp>& captured);

}  // namespace chorus::sensor_service
