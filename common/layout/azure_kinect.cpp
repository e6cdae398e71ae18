// Azure Kinect Body Tracking SDK (k4abt), and Orbbec Femto cameras through Orbbec's wrapper.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

// clang-format off
constexpr std::array<std::string_view, 32> kNames{
    "PELVIS", "SPINE_NAVEL", "SPINE_CHEST", "NECK",
    "CLAVICLE_LEFT", "SHOULDER_LEFT", "ELBOW_LEFT", "WRIST_LEFT", "HAND_LEFT", "HANDTIP_LEFT", "THUMB_LEFT",
    "CLAVICLE_RIGHT", "SHOULDER_RIGHT", "ELBOW_RIGHT", "WRIST_RIGHT", "HAND_RIGHT", "HANDTIP_RIGHT", "THUMB_RIGHT",
    "HIP_LEFT", "KNEE_LEFT", "ANKLE_LEFT", "FOOT_LEFT", "HIP_RIGHT", "KNEE_RIGHT", "ANKLE_RIGHT", "FOOT_RIGHT",
    "HEAD", "NOSE", "EYE_LEFT", "EAR_LEFT", "EYE_RIGHT", "EAR_RIGHT"};

// The tracker's NECK is the base of the neck, level with the clavicles; its HEAD is the base of the
// skull.
constexpr std::array kRecipes{
    only(JointId::SpineBase, 0), middle(JointId::SpineMid, 1, 2), neck(3, 29, 31), middle(JointId::Head, 29, 31),
    only(JointId::ShoulderLeft, 5), only(JointId::ElbowLeft, 6), only(JointId::WristLeft, 7), only(JointId::HandLeft, 8),
    only(JointId::ShoulderRight, 12), only(JointId::ElbowRight, 13), only(JointId::WristRight, 14), only(JointId::HandRight, 15),
    only(JointId::HipLeft, 18), only(JointId::KneeLeft, 19), only(JointId::AnkleLeft, 20), only(JointId::FootLeft, 21),
    only(JointId::HipRight, 22), only(JointId::KneeRight, 23), only(JointId::AnkleRight, 24), only(JointId::FootRight, 25),
    middle(JointId::SpineShoulder, 4, 11),
    only(JointId::HandTipLeft, 9), only(JointId::ThumbLeft, 10),
    only(JointId::HandTipRight, 16), only(JointId::ThumbRight, 17)};
// clang-format on

}  // namespace

/// Confidence is the SDK's level times 0.5: 0: none, 0.5: low (predicted behind an occlusion), 1:
/// medium.
const Layout kAzureKinect{"azure_kinect_32",
                          "Azure Kinect Body Tracking SDK",
                          "https://learn.microsoft.com/en-us/azure/kinect-dk/body-joints",
                          kNames,
                          kRecipes,
                          0.75,
                          0.25,
                          {27, 28, 30, 29, 31}};

}  // namespace chorus::layout
