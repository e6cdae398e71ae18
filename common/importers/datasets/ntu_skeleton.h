// NTU RGB+D .skeleton: one Kinect v2, up to six bodies, 25 joints with orientation, no times.
//
// The file is a frame count; per frame the number of bodies; per body a row of ten (id, hand
// states, lean, state), the joint count 25, and 25 rows: x y z, depth pixel, colour pixel, qw qx qy
// qz, state.  Metres, camera space.  The quaternion order w x y z was checked against the data:
// only then does the y axis lie along the bone that ends at the joint (median 0.0 deg).  The 57-bit
// body ids are replaced by 1, 2, ... in the order of appearance.
#pragma once

#include <filesystem>

#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

[[nodiscard]] Result<record::FrameRecording> read_ntu_skeleton(const std::filesystem::path& file,
                                                               const ImportOptions& options = {});

}  // namespace chorus::importers
