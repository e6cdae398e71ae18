// Fusion of people who are moved by motion capture: takes of jumping, climbing, dancing, crawling,
// which none of the simulator's own motions resemble.
//
// Takes are the .bvh, .amc, .c3d and .mvnx files of the folder that CHORUS_MOTIONS names; without
// it the cases are left out, with a note.  Each take is turned by a drawn angle, begins at a drawn
// place of its loop and is played forwards and backwards (common/synthetic/performer.h), so half of
// all running is running backwards.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/report/report.h"

namespace chorus::bench {

/// "motions-SENSORS-PROFILE": a ring of so many sensors around one person.
[[nodiscard]] std::vector<std::string> motion_cases();

/// Reports the case over all takes, and the first figures of each take as "NAME:TAKE"; also the
/// joints that ours has wrong by most, as rows "worst_JOINT_mm", left and right together.  Takes
/// that cannot be played are named in a note.
void measure_motions(Report& report, const std::string& name);

}  // namespace chorus::bench
