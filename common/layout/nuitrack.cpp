// Nuitrack, which works with most depth cameras (Orbbec, RealSense); it numbers the joints as
// OpenNI did.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

// clang-format off
constexpr std::array<std::string_view, 25> kNames{
    "JOINT_NONE", "JOINT_HEAD", "JOINT_NECK", "JOINT_TORSO", "JOINT_WAIST",
    "JOINT_LEFT_COLLAR", "JOINT_LEFT_SHOULDER", "JOINT_LEFT_ELBOW", "JOINT_LEFT_WRIST", "JOINT_LEFT_HAND", "JOINT_LEFT_FINGERTIP",
    "JOINT_RIGHT_COLLAR", "JOINT_RIGHT_SHOULDER", "JOINT_RIGHT_ELBOW", "JOINT_RIGHT_WRIST", "JOINT_RIGHT_HAND", "JOINT_RIGHT_FINGERTIP",
    "JOINT_LEFT_HIP", "JOINT_LEFT_KNEE", "JOINT_LEFT_ANKLE", "JOINT_LEFT_FOOT",
    "JOINT_RIGHT_HIP", "JOINT_RIGHT_KNEE", "JOINT_RIGHT_ANKLE", "JOINT_RIGHT_FOOT"};

// The tracker has numbers for fingertips and feet, but never fills them.
constexpr std::array kRecipes{
    only(JointId::SpineBase, 4), only(JointId::SpineMid, 3), only(JointId::Neck, 2), only(JointId::Head, 1),
    only(JointId::ShoulderLeft, 6), only(JointId::ElbowLeft, 7), only(JointId::WristLeft, 8), only(JointId::HandLeft, 9),
    only(JointId::ShoulderRight, 12), only(JointId::ElbowRight, 13), only(JointId::WristRight, 14), only(JointId::HandRight, 15),
    only(JointId::HipLeft, 17), only(JointId::KneeLeft, 18), only(JointId::AnkleLeft, 19),
    only(JointId::HipRight, 21), only(JointId::KneeRight, 22), only(JointId::AnkleRight, 23),
    middle(JointId::SpineShoulder, 5, 11)};
// clang-format on

}  // namespace

const Layout kNuitrack{
    "nuitrack_25",
    "Nuitrack",
    "http://download.3divi.com/Nuitrack/doc/structtdv_1_1nuitrack_1_1Skeleton.html",
    kNames,
    kRecipes,
    0.5,
    0.2};

}  // namespace chorus::layout
