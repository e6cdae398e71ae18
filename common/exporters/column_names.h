// What other programs call our joints.
#pragma once

#include <array>
#include <string_view>

#include "common/body/skeleton.h"

namespace chorus::exporters {

enum class ColumnNames { Chorus, Motive, Pose2Sim };

inline constexpr std::array<std::string_view, 3> kColumnNames{"chorus", "motive", "pose2sim"};

struct NamedJoint {
  JointId joint;
  std::string_view name;
};

/// Bones of OptiTrack's Motive, each named by the joint at which it begins; its collar bones have
/// no joint here.
inline constexpr std::array<NamedJoint, 19> kMotiveBones{{
    {JointId::SpineBase, "Hip"},       {JointId::SpineMid, "Ab"},
    {JointId::SpineShoulder, "Chest"}, {JointId::Neck, "Neck"},
    {JointId::Head, "Head"},           {JointId::ShoulderLeft, "LUArm"},
    {JointId::ElbowLeft, "LFArm"},     {JointId::WristLeft, "LHand"},
    {JointId::ShoulderRight, "RUArm"}, {JointId::ElbowRight, "RFArm"},
    {JointId::WristRight, "RHand"},    {JointId::HipLeft, "LThigh"},
    {JointId::KneeLeft, "LShin"},      {JointId::AnkleLeft, "LFoot"},
    {JointId::FootLeft, "LToe"},       {JointId::HipRight, "RThigh"},
    {JointId::KneeRight, "RShin"},     {JointId::AnkleRight, "RFoot"},
    {JointId::FootRight, "RToe"},
}};

/// Markers of Pose2Sim's HALPE_26 model.  Its neck is between the shoulders; its head is the top of
/// the head, ours the middle; it has no joint for our feet, which are nearest to its big toes.
inline constexpr std::array<NamedJoint, 17> kPose2SimMarkers{{
    {JointId::SpineBase, "Hip"},
    {JointId::HipRight, "RHip"},
    {JointId::KneeRight, "RKnee"},
    {JointId::AnkleRight, "RAnkle"},
    {JointId::FootRight, "RBigToe"},
    {JointId::HipLeft, "LHip"},
    {JointId::KneeLeft, "LKnee"},
    {JointId::AnkleLeft, "LAnkle"},
    {JointId::FootLeft, "LBigToe"},
    {JointId::SpineShoulder, "Neck"},
    {JointId::Head, "Head"},
    {JointId::ShoulderRight, "RShoulder"},
    {JointId::ElbowRight, "RElbow"},
    {JointId::WristRight, "RWrist"},
    {JointId::ShoulderLeft, "LShoulder"},
    {JointId::ElbowLeft, "LElbow"},
    {JointId::WristLeft, "LWrist"},
}};

}  // namespace chorus::exporters
