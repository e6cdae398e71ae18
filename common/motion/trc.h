// TRC: named points over time, as text (OpenSim, Motion Analysis, Pose2Sim, Theia, ...).
//
//   PathFileType  4  (X/Y/Z)  walk.trc
//   DataRate  CameraRate  NumFrames  NumMarkers  Units  OrigDataRate ...
//   60  60  100  2  mm  60  1  100
//   Frame#  Time  Hip  (two empty cells)  Neck
//                 X1  Y1  Z1  X2  Y2  Z2
//   1  0.000  x  y  z  x  y  z
//
// An empty cell is a point that was not seen.
#pragma once

#include <optional>
#include <string_view>

#include "common/motion/markers.h"

namespace chorus::motion {

/// Parses a file, in which +y is taken to be up.  The times of the rows count, not the rate; the
/// rows that are there count, not their announced number; a row that cannot be read is left out;
/// each with a note.  `metres_per_unit` replaces the unit that the file states.
[[nodiscard]] Result<MarkerTracks> parse_trc(std::string_view text, std::string_view origin,
                                             std::optional<double> metres_per_unit = std::nullopt);

}  // namespace chorus::motion
