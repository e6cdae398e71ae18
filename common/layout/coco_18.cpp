// OpenPose's COCO model with 18 key points, and the ZED SDK's BODY_18, which has the same ones.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

// clang-format off
constexpr std::array<std::string_view, 18> kNames{
    "NOSE", "NECK", "RIGHT_SHOULDER", "RIGHT_ELBOW", "RIGHT_WRIST", "LEFT_SHOULDER", "LEFT_ELBOW", "LEFT_WRIST",
    "RIGHT_HIP", "RIGHT_KNEE", "RIGHT_ANKLE", "LEFT_HIP", "LEFT_KNEE", "LEFT_ANKLE",
    "RIGHT_EYE", "LEFT_EYE", "RIGHT_EAR", "LEFT_EAR"};

// The tracker's NECK is the centre of the shoulders.
constexpr std::array kRecipes{
    middle(JointId::SpineBase, 8, 11), middle(JointId::SpineMid, 8, 11, 2, 5),
    neck(1, 16, 17), only(JointId::Neck, 1),
    middle(JointId::Head, 16, 17), only(JointId::Head, 16), only(JointId::Head, 17), only(JointId::Head, 0),
    only(JointId::ShoulderLeft, 5), only(JointId::ElbowLeft, 6), only(JointId::WristLeft, 7),
    only(JointId::ShoulderRight, 2), only(JointId::ElbowRight, 3), only(JointId::WristRight, 4),
    only(JointId::HipLeft, 11), only(JointId::KneeLeft, 12), only(JointId::AnkleLeft, 13),
    only(JointId::HipRight, 8), only(JointId::KneeRight, 9), only(JointId::AnkleRight, 10),
    only(JointId::SpineShoulder, 1)};
// clang-format on

}  // namespace

const Layout kCoco18{
    "coco_18",
    "OpenPose, COCO model",
    "https://github.com/CMU-Perceptual-Computing-Lab/openpose/blob/master/doc/02_output.md",
    kNames,
    kRecipes,
    0.4,
    0.1};

/// Confidence is keypoint_confidence / 100.
const Layout kZed18{"zed_18", "ZED SDK, BODY_18", "https://www.stereolabs.com/docs/body-tracking/",
                    kNames,   kRecipes,           0.5,
                    0.1};

}  // namespace chorus::layout
