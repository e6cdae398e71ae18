// Northwestern-UCLA Multiview Action3D as json: one Kinect v1 view, 20 joints, no times, no states.
//
// {"file_name", "skeletons": [frames][20][x, y, z], "label"}, metres in camera space.  The Kinect
// v1 has no Neck, hand tips and thumbs: these joints are NotTracked.  The views of one take are
// files named aAA_sSS_eEE_vVV; for some takes the dataset contains a copy of v02 as v03.
#pragma once

#include <filesystem>
#include <vector>

#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

/// The sensor is named after the view ("v01") unless the options name it.
[[nodiscard]] Result<record::FrameRecording> read_nw_ucla_json(const std::filesystem::path& file,
                                                               const ImportOptions& options = {});

/// Refuses a set in which two recordings have the same positions throughout: two different cameras
/// cannot produce these.
[[nodiscard]] Result<void> refuse_copies(const std::vector<record::FrameRecording>& views);

}  // namespace chorus::importers
