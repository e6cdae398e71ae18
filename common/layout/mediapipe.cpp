// MediaPipe Pose and BlazePose; also the 33 body landmarks of MediaPipe Holistic.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

// clang-format off
constexpr std::array<std::string_view, 33> kNames{
    "nose", "left_eye_inner", "left_eye", "left_eye_outer", "right_eye_inner", "right_eye", "right_eye_outer",
    "left_ear", "right_ear", "mouth_left", "mouth_right",
    "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist",
    "left_pinky", "right_pinky", "left_index", "right_index", "left_thumb", "right_thumb",
    "left_hip", "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle",
    "left_heel", "right_heel", "left_foot_index", "right_foot_index"};

constexpr std::array kRecipes{
    middle(JointId::SpineBase, 23, 24), middle(JointId::SpineMid, 23, 24, 11, 12),
    neck(11, 12, 7, 8), middle(JointId::Head, 7, 8),
    only(JointId::ShoulderLeft, 11), only(JointId::ElbowLeft, 13), only(JointId::WristLeft, 15),
    hand(JointId::HandLeft, 15, 17, 19),
    only(JointId::ShoulderRight, 12), only(JointId::ElbowRight, 14), only(JointId::WristRight, 16),
    hand(JointId::HandRight, 16, 18, 20),
    only(JointId::HipLeft, 23), only(JointId::KneeLeft, 25), only(JointId::AnkleLeft, 27), only(JointId::FootLeft, 31),
    only(JointId::HipRight, 24), only(JointId::KneeRight, 26), only(JointId::AnkleRight, 28), only(JointId::FootRight, 32),
    middle(JointId::SpineShoulder, 11, 12),
    middle(JointId::HandTipLeft, 17, 19), only(JointId::ThumbLeft, 21),
    middle(JointId::HandTipRight, 18, 20), only(JointId::ThumbRight, 22)};
// clang-format on

}  // namespace

/// Confidence is "visibility"; MediaPipe guesses invisible landmarks instead of leaving them out.
const Layout kMediapipe{"mediapipe_33",
                        "MediaPipe Pose, BlazePose",
                        "https://ai.google.dev/edge/mediapipe/solutions/vision/pose_landmarker",
                        kNames,
                        kRecipes,
                        0.6,
                        0.0,
                        {0, 2, 5, 7, 8}};

}  // namespace chorus::layout
