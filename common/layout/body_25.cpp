// OpenPose's default model, BODY_25.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

// clang-format off
constexpr std::array<std::string_view, 25> kNames{
    "Nose", "Neck", "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist", "MidHip",
    "RHip", "RKnee", "RAnkle", "LHip", "LKnee", "LAnkle", "REye", "LEye", "REar", "LEar",
    "LBigToe", "LSmallToe", "LHeel", "RBigToe", "RSmallToe", "RHeel"};

// The tracker's Neck is the centre of the shoulders.
constexpr std::array kRecipes{
    only(JointId::SpineBase, 8), middle(JointId::SpineMid, 1, 8),
    neck(1, 17, 18), only(JointId::Neck, 1),
    middle(JointId::Head, 17, 18), only(JointId::Head, 17), only(JointId::Head, 18), only(JointId::Head, 0),
    only(JointId::ShoulderLeft, 5), only(JointId::ElbowLeft, 6), only(JointId::WristLeft, 7),
    only(JointId::ShoulderRight, 2), only(JointId::ElbowRight, 3), only(JointId::WristRight, 4),
    only(JointId::HipLeft, 12), only(JointId::KneeLeft, 13), only(JointId::AnkleLeft, 14), only(JointId::FootLeft, 19),
    only(JointId::HipRight, 9), only(JointId::KneeRight, 10), only(JointId::AnkleRight, 11), only(JointId::FootRight, 22),
    only(JointId::SpineShoulder, 1)};
// clang-format on

}  // namespace

const Layout kBody25{
    "body_25",
    "OpenPose, BODY_25",
    "https://github.com/CMU-Perceptual-Computing-Lab/openpose/blob/master/doc/02_output.md",
    kNames,
    kRecipes,
    0.4,
    0.1};

}  // namespace chorus::layout
