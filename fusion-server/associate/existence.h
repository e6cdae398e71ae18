// Decides whether a track is somebody, at every instant for as long as the track lives.
//
// Bodies without a person come from furniture, mirrors, and sensors that are not where they were
// registered.  Each sensor that looks at the place and sees somebody speaks for the person, each
// one that looks there and sees nobody speaks against them.  The difference is the track's rate of
// belief, whose integral decides (as in integrated data association, Musicki, Evans and Stankovic
// 1994, with a rate in place of probabilities, because what a sensor says at one instant is what it
// said at the one before):
//
//   rate = sum of words(seen by) - 0.8 * sides(missed by) - 0.3 while it has not moved
//
// (1 instead of 0.3 if one of several sensors sees it and no other one looks there.)
//
// A word is 1.  It is less for a sensor that sees many whom only it sees, and 0 for a body far
// under or above the floor, and for a sensor that misses somebody whom more sensors see: its body
// is then taken for that person, misplaced.  Sensors on one side of the place count as one side and
// little more, because one thing may hide the place from all of them.  The rate is -1 for a body
// that all who see it show far under or above the floor, for an image in a mirror (mirrors.h), and
// where nobody else looks if all who see it miss somebody beside it whom more sensors see.
#pragma once

#include "fusion-server/associate/gaze.h"
#include "fusion-server/flow/standing.h"

namespace chorus::associate {

/// An instant counts as no more, whatever the pause before it.
inline constexpr Duration kLongestInstant = std::chrono::milliseconds(250);

/// How long the instant lasts, and what is asked.
struct Sitting {
  Duration elapsed{0};  ///< What the instant counts for: at most kLongestInstant.
  Duration passed{0};   ///< Since the previous instant.
  /// How long a body that has not moved waits where it is believed only if it moves.
  Duration doubt{0};
  bool floor_known = false;  ///< False: no body is judged by its height.
};

/// Takes the instant into the track's belief, and sets `admitted`: true from where the belief is
/// positive, false once it is clearly negative.  The track must have sights.
[[nodiscard]] Standing judge(Track& track, const Gaze& gaze, const Sitting& sitting);

/// Learns where the sensors see people, from an admitted track that they are sure of.
void learn(const Track& track, const Gaze& gaze, double elapsed, SightFields& fields);

/// True unless the whole body is under the floor, part of it deeper than a pit's floor, or all of
/// it higher than somebody on a platform.  A ray body is judged by `core` alone.
[[nodiscard]] bool is_on_floor(const PlacedView& view);

}  // namespace chorus::associate
