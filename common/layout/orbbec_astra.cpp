// Body tracking of the Orbbec Astra SDK.  Orbbec's Femto cameras use azure_kinect_32.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

// clang-format off
constexpr std::array<std::string_view, 19> kNames{
    "HEAD", "SHOULDER_SPINE", "LEFT_SHOULDER", "LEFT_ELBOW", "LEFT_HAND", "RIGHT_SHOULDER", "RIGHT_ELBOW", "RIGHT_HAND",
    "MID_SPINE", "BASE_SPINE", "LEFT_HIP", "LEFT_KNEE", "LEFT_FOOT", "RIGHT_HIP", "RIGHT_KNEE", "RIGHT_FOOT",
    "LEFT_WRIST", "RIGHT_WRIST", "NECK"};

// The tracker has no ankles.
constexpr std::array kRecipes{
    only(JointId::SpineBase, 9), only(JointId::SpineMid, 8), only(JointId::Neck, 18), only(JointId::Head, 0),
    only(JointId::ShoulderLeft, 2), only(JointId::ElbowLeft, 3), only(JointId::WristLeft, 16), only(JointId::HandLeft, 4),
    only(JointId::ShoulderRight, 5), only(JointId::ElbowRight, 6), only(JointId::WristRight, 17), only(JointId::HandRight, 7),
    only(JointId::HipLeft, 10), only(JointId::KneeLeft, 11), only(JointId::FootLeft, 12),
    only(JointId::HipRight, 13), only(JointId::KneeRight, 14), only(JointId::FootRight, 15),
    only(JointId::SpineShoulder, 1)};
// clang-format on

}  // namespace

/// Confidence is the joint's status times 0.5: 0 not tracked, 0.5 low, 1 tracked.
const Layout kOrbbecAstra{
    "orbbec_astra_19",
    "Orbbec Astra SDK",
    "https://github.com/orbbec/astra (include/astra/capi/streams/body_types.h)",
    kNames,
    kRecipes,
    0.75,
    0.25};

}  // namespace chorus::layout
