// The 17 key points of COCO: MoveNet, YOLO pose, RTMPose, ViTPose, AlphaPose, Detectron.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

// clang-format off
constexpr std::array<std::string_view, 17> kNames{
    "nose", "left_eye", "right_eye", "left_ear", "right_ear", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow",
    "left_wrist", "right_wrist", "left_hip", "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle"};

// From the side a detector misses the far ear; then the other ear or the nose stands for the head.
constexpr std::array kRecipes{
    middle(JointId::SpineBase, 11, 12), middle(JointId::SpineMid, 11, 12, 5, 6),
    neck(5, 6, 3, 4), middle(JointId::Neck, 5, 6),
    middle(JointId::Head, 3, 4), only(JointId::Head, 3), only(JointId::Head, 4), only(JointId::Head, 0),
    only(JointId::ShoulderLeft, 5), only(JointId::ElbowLeft, 7), only(JointId::WristLeft, 9),
    only(JointId::ShoulderRight, 6), only(JointId::ElbowRight, 8), only(JointId::WristRight, 10),
    only(JointId::HipLeft, 11), only(JointId::KneeLeft, 13), only(JointId::AnkleLeft, 15),
    only(JointId::HipRight, 12), only(JointId::KneeRight, 14), only(JointId::AnkleRight, 16),
    middle(JointId::SpineShoulder, 5, 6)};
// clang-format on

}  // namespace

const Layout kCoco17{"coco_17", "COCO key points", "https://cocodataset.org/#format-data",
                     kNames,    kRecipes,          0.5,
                     0.2};

}  // namespace chorus::layout
