// What a reference says of tracker and sensors, as a section of the report of `chorus evaluate`.
#pragma once

#include <string>
#include <vector>

#include "common/evaluation/place_error.h"
#include "common/report/report.h"

namespace chorus::ctl {

struct RefereedTake {
  std::string file;
  evaluation::TimeShift shift;  ///< Of the reference's times, which begin at 0.
  std::size_t joints = 0;       ///< That tracker and reference both show.
  double rms = 0.0;             ///< Distance of these joints, worlds aligned [m].
  std::vector<evaluation::RefereedLimb> limbs;
  std::vector<evaluation::PlacedLimb> places;  ///< Of the same limbs, in the same order.
};

/// A limb's name in the keys of figures: "left_forearm".
[[nodiscard]] std::string figure_key(inertial::Limb limb);

/// Errors of tracker and sensor by limb, and who is right where they disagree.
[[nodiscard]] report::Section reference_section(const RefereedTake& take, double tau);

/// One sentence: of how many disagreements the tracker errs, of how many the sensor.
[[nodiscard]] std::string reference_verdict(const RefereedTake& take);

}  // namespace chorus::ctl
