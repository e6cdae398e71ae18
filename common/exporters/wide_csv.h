// CSV, wide form: one row a frame.  Units are in the header; quaternions are continuous: of q and
// -q, which are one rotation, the one that is nearer to the frame before.
//
//   chorus    frame,time_s,utc,person,Head.x_m,Head.y_m,Head.z_m,Head.qx,...,Head.sd_mm, ...: a row
//             a frame and person; what is missing is empty
//   motive    the seven header lines of a take that OptiTrack's Motive exports, then bones with
//             rotation (X, Y, Z, W) and position in metres, all people in one row; the bones are
//             those of skeleton_fit.h, whose T-pose has identity rotations as Motive's has
//   pose2sim  frame,time_s,RHip_x_m,...: the markers' names of Pose2Sim, all people in one row
//
// World space, +y up.
#pragma once

#include <string>
#include <string_view>

#include "common/exporters/column_names.h"
#include "common/exporters/take.h"

namespace chorus::exporters {

/// `name` is the take's, for Motive's first line.  Unsupported: bones are asked for, and nobody
/// shows a SpineBase.
[[nodiscard]] Result<std::string> wide_csv_of(const Take& take, ColumnNames names,
                                              std::string_view name);

}  // namespace chorus::exporters
