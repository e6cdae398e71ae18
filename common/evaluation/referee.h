// A third witness: a reference (optical markers) beside a tracker and the sensors that judge it.
//
// Tracker and sensor only show that they disagree.  With a reference that is in the tracker's time
// and world, each has an error of its own (Eq. 13 against the reference), and a disagreement is
// somebody's.
#pragma once

#include <string_view>
#include <vector>

#include "common/evaluation/judge.h"

namespace chorus::evaluation {

/// Who is right: the one nearer to the reference, if it is within tau; else neither.
enum class Right : std::uint8_t { Tracker, Sensor, Neither };
/// "tracker", "sensor", "neither".
[[nodiscard]] std::string_view name_of(Right right);
[[nodiscard]] Right who_is_right(double tracker_error, double sensor_error, double tau);

/// Median and 90th percentile [rad, or m of places]; 0 of nothing.
struct ErrorSpread {
  double median = 0.0;
  double p90 = 0.0;
};

/// A time in which tracker and sensor disagree.
struct RefereedSegment {
  Segment segment;
  double tracker = 0.0;  ///< Median error against the reference within it [rad].
  double sensor = 0.0;
  Right right = Right::Neither;
};

/// One limb, at the tracker's instants that are judged and that the reference shows.
struct RefereedLimb {
  inertial::Limb limb = inertial::Limb::Pelvis;
  /// Errors against the reference.  Twist counts where tracker and reference both show it, so that
  /// both are measured alike.
  ErrorTrack tracker, sensor;
  ErrorSpread tracker_spread, sensor_spread;
  /// Instants within the disagreements, by who is right then (index: Right).
  std::array<std::size_t, 3> instants{};
  std::vector<RefereedSegment> segments;  ///< Disagreements that the reference shows.

  [[nodiscard]] std::size_t disagreements() const {
    return instants[0] + instants[1] + instants[2];
  }
};

/// The shift that brings a reference of another clock to the tracker's: their bones turn alike.
/// Tried is every shift at which half of the shorter one overlaps.  Refused: less than 5 s in one
/// of them, no limb that both show, no shift at which they move alike, or several.
[[nodiscard]] Result<TimeShift> reference_shift(const TrackedBody& tracked,
                                                const TrackedBody& reference);

/// Each judged limb that the reference shows.  `tracked` and `sensors` are those of the judgement,
/// `reference` is in the tracker's time and world.
[[nodiscard]] std::vector<RefereedLimb> refereed(const Judgement& found, const TrackedBody& tracked,
                                                 const std::vector<JudgeSensor>& sensors,
                                                 const TrackedBody& reference, double tau);

}  // namespace chorus::evaluation
