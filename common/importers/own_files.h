// Reads two simple formats of ours, in which other trackers' data can be imported (`chorus export
// --format csv` and `chorus fuse --out X.ndjson` write them, too), and PyMoCapViewer's log.
//
// CSV: one row per joint; the first row names the columns; docs/guide/recording.md explains them.
// NDJSON: one /frame document per line (proto/README.md, section 3).
#pragma once

#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

/// Requires the columns joint, x_m, y_m, z_m and utc or time_s; person, state, qx..qw and sd_mm
/// (standard deviation along each axis) are optional. The rows of one instant must be adjacent, and
/// the instants in order.
[[nodiscard]] Result<record::FrameRecording> read_joint_csv(const std::filesystem::path& file,
                                                            const ImportOptions& options = {});

[[nodiscard]] Result<record::FrameRecording> read_frame_lines(const std::filesystem::path& file,
                                                              const ImportOptions& options = {});

/// PyMoCapViewer's log of Azure Kinect's body tracking: `timestamp` [us], `body_idx`, and for each
/// of 32 landmarks its confidence and x, y, z [mm], named "PELVIS (c)", "PELVIS (x)", ...
[[nodiscard]] Result<record::FrameRecording> read_azure_kinect_csv(
    const std::filesystem::path& file, const ImportOptions& options = {});

}  // namespace chorus::importers
