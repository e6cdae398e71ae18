// Recorded human motion as truth: turns C3D, TRC, BVH, HTR and MVNX files (common/motion) into a
// recording of an ideal sensor.
//
// The sensor's space is the world of the file: +y up, floor y = 0, extrinsics identity.  So motion
// capture data can be replayed, fused and exported like any recording, and also serves as the
// truth.
#pragma once

#include <filesystem>
#include <vector>

#include "common/importers/camera_views.h"
#include "common/importers/captured.h"
#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

struct MotionRecording {
  record::FrameRecording recording;  ///< The bodies' ids are those in the names of the file's
                                     ///< subjects ("P10"), or 1, 2, ... in their order.
  std::vector<TruthFrame> truth;     ///< The same in world space.
  FileSpace space = {};
};

/// Among the recording's notes are "labels": points of a C3D file that are not joints; "joints":
/// the number of joints; "time": that the file states no UTC; "gaps": frames that its times leave
/// out; "unit": what was assumed for BVH; "damage.1", "damage.2", ...: what was salvaged.
[[nodiscard]] Result<MotionRecording> read_motion_file(const std::filesystem::path& file,
                                                       MotionFormat format,
                                                       const ImportOptions& options = {});

}  // namespace chorus::importers
