// Names, bones and mirror pairs of the 25 joints, as tables.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "common/body/skeleton.h"

namespace chorus {

/// "SpineBase", "HandTipLeft": the names of the Kinect v2 SDK; also used in URI fragments and JSON
/// keys.
// clang-format off
inline constexpr std::array<std::string_view, kJointCount> kJointNames{
    "SpineBase", "SpineMid", "Neck", "Head",
    "ShoulderLeft", "ElbowLeft", "WristLeft", "HandLeft",
    "ShoulderRight", "ElbowRight", "WristRight", "HandRight",
    "HipLeft", "KneeLeft", "AnkleLeft", "FootLeft",
    "HipRight", "KneeRight", "AnkleRight", "FootRight",
    "SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight", "ThumbRight"};
// clang-format on

[[nodiscard]] constexpr std::string_view name_of(JointId id) { return kJointNames[index_of(id)]; }
[[nodiscard]] std::optional<JointId> joint_named(std::string_view name);

struct Bone {
  JointId parent;
  JointId child;
};

/// Every joint except SpineBase has one parent; parents come before children.
inline constexpr std::array<Bone, kJointCount - 1> kBones{{
    {JointId::SpineBase, JointId::SpineMid},          {JointId::SpineMid, JointId::SpineShoulder},
    {JointId::SpineShoulder, JointId::Neck},          {JointId::Neck, JointId::Head},
    {JointId::SpineShoulder, JointId::ShoulderLeft},  {JointId::ShoulderLeft, JointId::ElbowLeft},
    {JointId::ElbowLeft, JointId::WristLeft},         {JointId::WristLeft, JointId::HandLeft},
    {JointId::HandLeft, JointId::HandTipLeft},        {JointId::WristLeft, JointId::ThumbLeft},
    {JointId::SpineShoulder, JointId::ShoulderRight}, {JointId::ShoulderRight, JointId::ElbowRight},
    {JointId::ElbowRight, JointId::WristRight},       {JointId::WristRight, JointId::HandRight},
    {JointId::HandRight, JointId::HandTipRight},      {JointId::WristRight, JointId::ThumbRight},
    {JointId::SpineBase, JointId::HipLeft},           {JointId::HipLeft, JointId::KneeLeft},
    {JointId::KneeLeft, JointId::AnkleLeft},          {JointId::AnkleLeft, JointId::FootLeft},
    {JointId::SpineBase, JointId::HipRight},          {JointId::HipRight, JointId::KneeRight},
    {JointId::KneeRight, JointId::AnkleRight},        {JointId::AnkleRight, JointId::FootRight},
}};

struct MirrorPair {
  JointId left;
  JointId right;
};

inline constexpr std::array<MirrorPair, 10> kMirrorPairs{{
    {JointId::ShoulderLeft, JointId::ShoulderRight},
    {JointId::ElbowLeft, JointId::ElbowRight},
    {JointId::WristLeft, JointId::WristRight},
    {JointId::HandLeft, JointId::HandRight},
    {JointId::HandTipLeft, JointId::HandTipRight},
    {JointId::ThumbLeft, JointId::ThumbRight},
    {JointId::HipLeft, JointId::HipRight},
    {JointId::KneeLeft, JointId::KneeRight},
    {JointId::AnkleLeft, JointId::AnkleRight},
    {JointId::FootLeft, JointId::FootRight},
}};

/// The parent of this joint; SpineBase is its own parent.
[[nodiscard]] JointId parent_of(JointId id);

/// The joint on the other side; a centre joint is its own mirror.
[[nodiscard]] JointId mirror(JointId id);

/// Joints on the body's centre axis: they look the same from the front and from behind (Otto 3.2).
inline constexpr std::array kCoreJoints{JointId::SpineBase, JointId::SpineMid,
                                        JointId::SpineShoulder, JointId::Neck, JointId::Head};

}  // namespace chorus
