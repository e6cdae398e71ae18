// The 23 body segments of Xsens MVN's network stream, in the order of their ids 1..23.
//
// The only table of them: our output (fusion-server/mxtp) places a segment's origin from our joints
// by it, and our input (mxtp_decoder.h) names segments by it.  Order and meaning are from Xsens,
// MVN real-time network streaming protocol; the names are those of MVNX files, by which
// common/motion makes our joints from segments.
#pragma once

#include <array>
#include <string_view>

#include "common/body/skeleton.h"

namespace chorus::suit {

struct MxtpSegment {
  std::string_view name;
  /// The segment's origin lies at the fraction `share` of the way between two joints (beyond the
  /// second one if more than 1).
  JointId from;
  JointId to;
  double share;
};

inline constexpr std::size_t kMxtpSegmentCount = 23;

// Neck and head are the inverse of the import of MVN files (common/motion): MVN's neck begins at
// our SpineShoulder and ends at the joint at which its head begins; our Neck is half-way between.
inline constexpr std::array<MxtpSegment, kMxtpSegmentCount> kMxtpSegments{{
    {"Pelvis", JointId::SpineBase, JointId::SpineBase, 0.0},
    {"L5", JointId::SpineBase, JointId::SpineMid, 1.0 / 3.0},
    {"L3", JointId::SpineBase, JointId::SpineMid, 2.0 / 3.0},
    {"T12", JointId::SpineMid, JointId::SpineMid, 0.0},
    {"T8", JointId::SpineMid, JointId::SpineShoulder, 0.5},
    {"Neck", JointId::SpineShoulder, JointId::SpineShoulder, 0.0},
    {"Head", JointId::SpineShoulder, JointId::Neck, 2.0},
    {"RightShoulder", JointId::SpineShoulder, JointId::ShoulderRight, 0.3},
    {"RightUpperArm", JointId::ShoulderRight, JointId::ShoulderRight, 0.0},
    {"RightForeArm", JointId::ElbowRight, JointId::ElbowRight, 0.0},
    {"RightHand", JointId::WristRight, JointId::WristRight, 0.0},
    {"LeftShoulder", JointId::SpineShoulder, JointId::ShoulderLeft, 0.3},
    {"LeftUpperArm", JointId::ShoulderLeft, JointId::ShoulderLeft, 0.0},
    {"LeftForeArm", JointId::ElbowLeft, JointId::ElbowLeft, 0.0},
    {"LeftHand", JointId::WristLeft, JointId::WristLeft, 0.0},
    {"RightUpperLeg", JointId::HipRight, JointId::HipRight, 0.0},
    {"RightLowerLeg", JointId::KneeRight, JointId::KneeRight, 0.0},
    {"RightFoot", JointId::AnkleRight, JointId::AnkleRight, 0.0},
    {"RightToe", JointId::FootRight, JointId::FootRight, 0.0},
    {"LeftUpperLeg", JointId::HipLeft, JointId::HipLeft, 0.0},
    {"LeftLowerLeg", JointId::KneeLeft, JointId::KneeLeft, 0.0},
    {"LeftFoot", JointId::AnkleLeft, JointId::AnkleLeft, 0.0},
    {"LeftToe", JointId::FootLeft, JointId::FootLeft, 0.0},
}};

}  // namespace chorus::suit
