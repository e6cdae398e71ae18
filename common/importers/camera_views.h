// Real camera views as recordings: landmarks + calibration -> 25 joints in each camera's own space.
//
// The folder holds cameras.json (camera_set.h), one landmark file per camera (landmarks.h) and, if
// the truth is known, triangulated.json.  The published extrinsics and the truth are imported too,
// in our world.
#pragma once

#include <filesystem>
#include <vector>

#include "common/importers/camera_set.h"
#include "common/importers/import_options.h"
#include "common/importers/landmark_fit.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

/// One view; a frame without detections, or whose landmarks fit no body, is empty.
[[nodiscard]] Result<record::FrameRecording> read_camera_view(
    const std::filesystem::path& file, const std::vector<CalibratedCamera>& cameras,
    const ImportOptions& options = {}, Lateral lateral = Lateral::PixelRay);

/// The person as triangulated from all views, at the instant of the views' frame `index`.
struct TruthFrame {
  std::uint64_t index = 0;
  Skeleton<WorldSpace> skeleton;
  std::uint64_t person = 1;  ///< A frame with several people has several entries.
};

/// Reads {"frames": [frame][33] x [x, y, z] or null}, metres, z up, as our joints in our world.
[[nodiscard]] Result<std::vector<TruthFrame>> read_triangulation(const std::filesystem::path& file,
                                                                 const ImportLimits& limits = {});

}  // namespace chorus::importers
