// A person's own upright stance: what the measures are while they stand upright with their arms
// down.  Angles count from there, so that constant errors of joints cancel.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/posture/measures.h"
#include "common/time/timestamp.h"

namespace chorus::posture {

struct Instant {
  Timestamp at;
  Measures measures;
};

struct Neutral {
  Measures stance;  ///< Medians; NaN: not measured then, so nothing is taken off.
  Timestamp from;
  Timestamp until;
  std::size_t instants = 0;
};

/// The measures relative to the stance, as each row of the table says.
[[nodiscard]] Measures relative_to(const Neutral& neutral, const Measures& measures);

/// What the stance leaves of the standard deviation that joints state: the larger part of their
/// error is where a tracker takes a joint to be, and is the same in the stance.  Held angles less
/// the stance err by 0.3 to 0.6 of what the joints state (median over the angles), with eight
/// cameras as with one Kinect v2 against Vicon (docs/benchmarks/ergonomics.md).
inline constexpr double kLeftByStance = 0.5;

/// How long one stands for it.
inline constexpr Duration kStanceLasts = std::chrono::seconds(2);

/// The medians of instants that are a stance, of their sizes for what is Shortened; a measure that
/// fewer than five instants know is NaN.  Not empty.
[[nodiscard]] Neutral stance_of(std::span<const Instant> instants);

/// The stance of these instants, in the order of time, which somebody says are one ("stand upright,
/// arms down").  InvalidArgument if it is plainly none (knees or trunk bent, arms raised), Timeout
/// if fewer than five instants or none of a measure's joints were seen; the message says what to
/// do.
[[nodiscard]] Result<Neutral> neutral_of(std::span<const Instant> instants);

/// The calmest upright stretch of kStanceLasts in a recording; if there is none of that length, of
/// half of it.
[[nodiscard]] std::optional<Neutral> calm_stance(std::span<const Instant> instants);

/// The medians over all instants at which the person stands, wherever they are in the recording:
/// with the trunk upright and the knees straight, and for what is measured of an arm with that arm
/// hanging.  Whether they do is seen in `judged` (the same instants, of the same or of another
/// tracker).  None if they stand for less than a second of 30 Hz.
[[nodiscard]] std::optional<Neutral> standing_stance(std::span<const Instant> instants,
                                                     std::span<const Instant> judged);

/// The calm stance; if nobody stands still so long, the standing one.
[[nodiscard]] std::optional<Neutral> find_neutral(std::span<const Instant> instants);

/// Why these measures are no upright stance ("the left knee is bent by 40 degrees"); empty: they
/// are one.
[[nodiscard]] std::string not_upright(const Measures& measures);

}  // namespace chorus::posture
