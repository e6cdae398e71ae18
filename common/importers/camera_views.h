// Views of real cameras as recordings: turns landmarks and calibration into 25 joints in each
// camera's sensor space.
//
// The folder contains cameras.json (camera_set.h), one landmark file per camera (landmarks.h) and,
// if the truth is known, triangulated.json.  The published extrinsics and the truth are imported
// too, and moved into our world.
#pragma once

#include <filesystem>
#include <vector>

#include "common/importers/camera_set.h"
#include "common/importers/import_options.h"
#include "common/importers/landmark_fit.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

/// Reads one view.  A frame in which nobody was detected, or whose landmarks fit no body, has no
/// bodies.
[[nodiscard]] Result<record::FrameRecording> read_camera_view(
    const std::filesystem::path& file, const std::vector<CalibratedCamera>& cameras,
    const ImportOptions& options = {}, Lateral lateral = Lateral::PixelRay);

/// The person as triangulated from all views, at the instant of frame `index` of the views.
struct TruthFrame {
  std::uint64_t index = 0;
  Skeleton<WorldSpace> skeleton;
  std::uint64_t person = 1;  ///< A frame with several people has several entries.
};

/// Reads {"frames": [frame][33] x [x, y, z] or null}, metres, z up, as our joints in our world.
[[nodiscard]] Result<std::vector<TruthFrame>> read_triangulation(const std::filesystem::path& file,
                                                                 const ImportLimits& limits = {});

}  // namespace chorus::importers
