// ZED SDK: BODY_34 and BODY_38.  BODY_18 is in coco_18.cpp.
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

constexpr std::string_view kSource = "https://www.stereolabs.com/docs/body-tracking/";

// clang-format off
constexpr std::array<std::string_view, 34> kNames34{
    "PELVIS", "NAVAL_SPINE", "CHEST_SPINE", "NECK",
    "LEFT_CLAVICLE", "LEFT_SHOULDER", "LEFT_ELBOW", "LEFT_WRIST", "LEFT_HAND", "LEFT_HANDTIP", "LEFT_THUMB",
    "RIGHT_CLAVICLE", "RIGHT_SHOULDER", "RIGHT_ELBOW", "RIGHT_WRIST", "RIGHT_HAND", "RIGHT_HANDTIP", "RIGHT_THUMB",
    "LEFT_HIP", "LEFT_KNEE", "LEFT_ANKLE", "LEFT_FOOT", "RIGHT_HIP", "RIGHT_KNEE", "RIGHT_ANKLE", "RIGHT_FOOT",
    "HEAD", "NOSE", "LEFT_EYE", "LEFT_EAR", "RIGHT_EYE", "RIGHT_EAR", "LEFT_HEEL", "RIGHT_HEEL"};

constexpr std::array kRecipes34{
    only(JointId::SpineBase, 0), middle(JointId::SpineMid, 1, 2),
    neck(3, 29, 31), only(JointId::Neck, 3), middle(JointId::Head, 29, 31), only(JointId::Head, 26),
    only(JointId::ShoulderLeft, 5), only(JointId::ElbowLeft, 6), only(JointId::WristLeft, 7), only(JointId::HandLeft, 8),
    only(JointId::ShoulderRight, 12), only(JointId::ElbowRight, 13), only(JointId::WristRight, 14), only(JointId::HandRight, 15),
    only(JointId::HipLeft, 18), only(JointId::KneeLeft, 19), only(JointId::AnkleLeft, 20), only(JointId::FootLeft, 21),
    only(JointId::HipRight, 22), only(JointId::KneeRight, 23), only(JointId::AnkleRight, 24), only(JointId::FootRight, 25),
    middle(JointId::SpineShoulder, 4, 11),
    only(JointId::HandTipLeft, 9), only(JointId::ThumbLeft, 10), only(JointId::HandTipRight, 16), only(JointId::ThumbRight, 17)};

constexpr std::array<std::string_view, 38> kNames38{
    "PELVIS", "SPINE_1", "SPINE_2", "SPINE_3", "NECK", "NOSE", "LEFT_EYE", "RIGHT_EYE", "LEFT_EAR", "RIGHT_EAR",
    "LEFT_CLAVICLE", "RIGHT_CLAVICLE", "LEFT_SHOULDER", "RIGHT_SHOULDER", "LEFT_ELBOW", "RIGHT_ELBOW", "LEFT_WRIST", "RIGHT_WRIST",
    "LEFT_HIP", "RIGHT_HIP", "LEFT_KNEE", "RIGHT_KNEE", "LEFT_ANKLE", "RIGHT_ANKLE", "LEFT_BIG_TOE", "RIGHT_BIG_TOE",
    "LEFT_SMALL_TOE", "RIGHT_SMALL_TOE", "LEFT_HEEL", "RIGHT_HEEL", "LEFT_HAND_THUMB_4", "RIGHT_HAND_THUMB_4",
    "LEFT_HAND_INDEX_1", "RIGHT_HAND_INDEX_1", "LEFT_HAND_MIDDLE_4", "RIGHT_HAND_MIDDLE_4", "LEFT_HAND_PINKY_1", "RIGHT_HAND_PINKY_1"};

// Among the landmarks of the hand, ..._1 is a knuckle and ..._4 a tip.
constexpr std::array kRecipes38{
    only(JointId::SpineBase, 0), only(JointId::SpineMid, 2),
    neck(12, 13, 8, 9), only(JointId::Neck, 4),
    middle(JointId::Head, 8, 9), only(JointId::Head, 8), only(JointId::Head, 9), only(JointId::Head, 5),
    only(JointId::ShoulderLeft, 12), only(JointId::ElbowLeft, 14), only(JointId::WristLeft, 16), hand(JointId::HandLeft, 16, 32, 36),
    only(JointId::ShoulderRight, 13), only(JointId::ElbowRight, 15), only(JointId::WristRight, 17), hand(JointId::HandRight, 17, 33, 37),
    only(JointId::HipLeft, 18), only(JointId::KneeLeft, 20), only(JointId::AnkleLeft, 22), only(JointId::FootLeft, 24),
    only(JointId::HipRight, 19), only(JointId::KneeRight, 21), only(JointId::AnkleRight, 23), only(JointId::FootRight, 25),
    middle(JointId::SpineShoulder, 12, 13),
    only(JointId::HandTipLeft, 34), only(JointId::ThumbLeft, 30), only(JointId::HandTipRight, 35), only(JointId::ThumbRight, 31)};
// clang-format on

}  // namespace

/// Here and below, confidence is keypoint_confidence / 100.
const Layout kZed34{"zed_34", "ZED SDK, BODY_34",  kSource, kNames34, kRecipes34, 0.5,
                    0.1,      {27, 28, 30, 29, 31}};
const Layout kZed38{"zed_38", "ZED SDK, BODY_38", kSource, kNames38, kRecipes38, 0.5,
                    0.1,      {5, 6, 7, 8, 9}};

}  // namespace chorus::layout
