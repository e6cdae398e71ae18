// Landmarks in pictures, as OpenPose, RTMPose (RTMLib, Pose2Sim), MMPose, AlphaPose and COCO's
// tools write them (pose_document.h): a folder per camera with one JSON file per picture, or one
// file per video.  They become rays.
#pragma once

#include <filesystem>

#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"
#include "common/sensor/camera_image.h"

namespace chorus::importers {

struct PoseCamera {
  Intrinsics intrinsics;
  double rate_hz = 30.0;  ///< Pictures per second.
};

/// One camera.  A picture's number is in its file's name (picture_numbers.h), or its "frame_id";
/// number 0 is at options.start.  Conflict when two pictures have the same number.  In a folder, a
/// damaged file yields no frame; the note "damage.1" counts them and names the first.  NotFound
/// when no file of a folder can be used; InvalidArgument when the landmarks do not lie in pictures
/// of the intrinsics' size.
[[nodiscard]] Result<record::FrameRecording> read_pose_frames(const std::filesystem::path& input,
                                                              const PoseCamera& camera,
                                                              const ImportOptions& options = {});

}  // namespace chorus::importers
