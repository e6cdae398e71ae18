// Recorded human motion as truth: turns C3D, BVH and MVNX files (common/motion) into a recording of
// an ideal sensor.
//
// The sensor's space is the world of the file: +y up, floor y = 0, extrinsics identity.  So motion
// capture data can be replayed, fused and exported like any recording, and also serves as the
// truth.
#pragma once

#include <filesystem>
#include <vector>

#include "common/importers/camera_views.h"
#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

enum class MotionFormat { C3d, Bvh, Mvnx };

struct MotionRecording {
  record::FrameRecording recording;  ///< The bodies' ids are those in the names of the file's
                                     ///< subjects ("P10"), or 1, 2, ... in their order.
  std::vector<TruthFrame> truth;     ///< The same in world space.
};

/// Among the recording's notes are "labels": points of a C3D file that are not joints; "joints":
/// the number of joints; "time": that the file states only a rate.  BVH lengths are centimetres
/// unless `options.metres_per_unit` says otherwise.
[[nodiscard]] Result<MotionRecording> read_motion_file(const std::filesystem::path& file,
                                                       MotionFormat format,
                                                       const ImportOptions& options = {});

}  // namespace chorus::importers
