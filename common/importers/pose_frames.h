// Landmarks in pictures, as OpenPose, RTMPose (RTMLib, Pose2Sim) and MMPose write them: a folder
// per camera with one JSON file per picture, or one file per video.  They become rays.
//
//   OpenPose  {"people": [{"person_id": [-1], "pose_keypoints_2d": [u, v, confidence, ...]}]}
//   MMPose    [{"keypoints": [[u, v], ...], "keypoint_scores": [...]}] for a picture;
//             [{"frame_id": 0, "instances": [...]}] or {"instance_info": [...]} for a video
//
// The layout follows from the number of landmarks of a person: BODY_25, COCO 17 and 18, HALPE 26,
// and the bodies of COCO wholebody (133) and HALPE (136).
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
