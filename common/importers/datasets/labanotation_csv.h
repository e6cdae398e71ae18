// LabanotationSuite csv (microsoft/LabanotationSuite, KinectReader): one Kinect v2, a body per row.
//
// A row is the capture time in ticks of 100 ns, then 25 x (x, y, z, state) in SDK order, metres,
// state 0/1/2 as in JointState.  Ticks since 1601 (FILETIME), 0001 (.NET) or 1970 that fall into
// 2010-2100 are kept as UTC.  Other ticks count from the start of the sensor, and are shifted so
// that the first row is at `options.start` (the recording's notes say so).  A row that repeats the
// capture time of the row before is dropped and counted.
#pragma once

#include <filesystem>

#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

/// Name of the note in a recording whose file counts from the start of its sensor; its value is the
/// ticks of the first row [100 ns].
inline constexpr const char* kBootTicksNote = "boot_ticks";

[[nodiscard]] Result<record::FrameRecording> read_labanotation_csv(
    const std::filesystem::path& file, const ImportOptions& options = {});

}  // namespace chorus::importers
