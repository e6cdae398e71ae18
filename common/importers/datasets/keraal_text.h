// KERAAL Kinect text: one Kinect v2, one body per row, 25 x (x y z qw qx qy qz), 30 Hz; without
// times and states.
//
// The notes that come with the format say x y z w, but the quaternions are w x y z: only then does
// the y axis lie along the bone that ends at the joint (median angle 0.0 deg, against 51-179 deg).
// Every joint counts as tracked.
#pragma once

#include <filesystem>

#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

[[nodiscard]] Result<record::FrameRecording> read_keraal_text(const std::filesystem::path& file,
                                                              const ImportOptions& options = {});

}  // namespace chorus::importers
