// Halpe body: AlphaPose and RTMPose "body with feet", the default of RTMLib and Pose2Sim.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

// clang-format off
constexpr std::array<std::string_view, 26> kNames{
    "Nose", "LEye", "REye", "LEar", "REar", "LShoulder", "RShoulder", "LElbow", "RElbow", "LWrist", "RWrist",
    "LHip", "RHip", "LKnee", "RKnee", "LAnkle", "RAnkle", "Head", "Neck", "Hip",
    "LBigToe", "RBigToe", "LSmallToe", "RSmallToe", "LHeel", "RHeel"};

// The tracker's Head is the top of the head, so our Head is made of the ears.
constexpr std::array kRecipes{
    only(JointId::SpineBase, 19), middle(JointId::SpineMid, 11, 12, 5, 6),
    neck(5, 6, 3, 4), only(JointId::Neck, 18),
    middle(JointId::Head, 3, 4), only(JointId::Head, 3), only(JointId::Head, 4), only(JointId::Head, 0),
    only(JointId::ShoulderLeft, 5), only(JointId::ElbowLeft, 7), only(JointId::WristLeft, 9),
    only(JointId::ShoulderRight, 6), only(JointId::ElbowRight, 8), only(JointId::WristRight, 10),
    only(JointId::HipLeft, 11), only(JointId::KneeLeft, 13), only(JointId::AnkleLeft, 15), only(JointId::FootLeft, 20),
    only(JointId::HipRight, 12), only(JointId::KneeRight, 14), only(JointId::AnkleRight, 16), only(JointId::FootRight, 21),
    middle(JointId::SpineShoulder, 5, 6)};
// clang-format on

}  // namespace

const Layout kHalpe26{"halpe_26",
                      "Halpe body with feet",
                      "https://github.com/Fang-Haoshu/Halpe-FullBody",
                      kNames,
                      kRecipes,
                      0.5,
                      0.2};

}  // namespace chorus::layout
