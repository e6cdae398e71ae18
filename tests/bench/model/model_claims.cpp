#include "tests/bench/model/model_claims.h"

#include "common/base/units.h"
#include "common/body/bones.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using enum JointId;

template <JointId kJoint, int kAxis>
double white(const LogStatistics& s) {
  return to_mm(s.white[index_of(kJoint)][kAxis]);
}
template <JointId kJoint, int kAxis>
double white_inferred(const LogStatistics& s) {
  return to_mm(s.white_inferred[index_of(kJoint)][kAxis]);
}
template <JointId kChild>
double bone(const LogStatistics& s) {
  return to_mm(s.bone_std.at(kChild));
}
template <JointId kJoint>
double inferred(const LogStatistics& s) {
  return 100.0 * s.inferred_share[index_of(kJoint)];
}
/// Mean over both sides.  Our walkers always turn the same way, which hides one side more than the
/// other, so one side alone is not comparable.
template <JointId kLeft>
double either_bone(const LogStatistics& s) {
  return to_mm(0.5 * (s.bone_std.at(kLeft) + s.bone_std.at(mirror(kLeft))));
}
template <JointId kLeft>
double either_inferred(const LogStatistics& s) {
  const double left = s.inferred_share[index_of(kLeft)];
  return 50.0 * (left + s.inferred_share[index_of(mirror(kLeft))]);
}
template <JointId kChild>
double next_frame(const LogStatistics& s) {
  return s.lag_frame.at(kChild);
}
template <JointId kChild>
double third(const LogStatistics& s) {
  return s.lag_third.at(kChild);
}
double later(const LogStatistics& s) {
  std::vector<double> all;
  for (const auto& [child, value] : s.lag_later) all.push_back(value);
  return median(all);
}
template <std::size_t kWhich>
double step(const LogStatistics& s) {
  return 1e3 * s.steps[kWhich];
}
double unoriented(const LogStatistics& s) { return static_cast<double>(s.unoriented); }

// In claims about steps between frames, the lower end is from the gesturing person's log, which has
// capture times; the upper end is from a polled log.
constexpr LogClaim kWalking[] = {
    {{"log-white", "neck_x_mm", "mm", {1.1, 1.2}}, white<Neck, 0>},
    {{"log-white", "neck_y_mm", "mm", {0.8, 1.8}}, white<Neck, 1>},
    {{"log-white", "neck_z_mm", "mm", {2.5, 4.3}}, white<Neck, 2>},
    {{"log-white", "chest_x_mm", "mm", {1.3, 1.3}}, white<SpineShoulder, 0>},
    {{"log-white", "chest_y_mm", "mm", {1.0, 1.5}}, white<SpineShoulder, 1>},
    {{"log-white", "chest_z_mm", "mm", {2.7, 4.1}}, white<SpineShoulder, 2>},
    {{"log-white", "spine_mid_x_mm", "mm", {1.5, 2.2}}, white<SpineMid, 0>},
    {{"log-white", "spine_mid_y_mm", "mm", {1.3, 1.9}}, white<SpineMid, 1>},
    {{"log-white", "spine_mid_z_mm", "mm", {3.3, 4.9}}, white<SpineMid, 2>},
    {{"log-white", "spine_base_x_mm", "mm", {2.3, 4.7}}, white<SpineBase, 0>},
    {{"log-white", "spine_base_y_mm", "mm", {1.9, 3.5}}, white<SpineBase, 1>},
    {{"log-white", "spine_base_z_mm", "mm", {3.7, 6.8}}, white<SpineBase, 2>},
    {{"log-white", "hip_x_mm", "mm", {4, 5}}, white<HipLeft, 0>},
    {{"log-white", "hip_y_mm", "mm", {3.6, 3.6}}, white<HipLeft, 1>},
    {{"log-white", "hip_z_mm", "mm", {7, 8}}, white<HipLeft, 2>},
    {{"log-white", "knee_x_mm", "mm", {3, 3}}, white<KneeLeft, 0>},
    {{"log-white", "knee_y_mm", "mm", {5, 7}}, white<KneeLeft, 1>},
    {{"log-white", "knee_z_mm", "mm", {3, 5}}, white<KneeLeft, 2>},
    {{"log-white", "wrist_x_mm", "mm", {3, 7}}, white<WristLeft, 0>},
    {{"log-white", "wrist_y_mm", "mm", {3, 5}}, white<WristLeft, 1>},
    {{"log-white", "wrist_z_mm", "mm", {5, 7}}, white<WristLeft, 2>},
    {{"log-white", "ankle_x_mm", "mm", {4, 4}}, white<AnkleLeft, 0>},
    {{"log-white", "ankle_y_mm", "mm", {10, 13}}, white<AnkleLeft, 1>},
    {{"log-white", "ankle_z_mm", "mm", {5, 9}}, white<AnkleLeft, 2>},
    {{"log-white", "foot_x_mm", "mm", {8, 9}}, white<FootLeft, 0>},
    {{"log-white", "foot_y_mm", "mm", {21, 21}}, white<FootLeft, 1>},
    {{"log-white", "foot_z_mm", "mm", {17, 17}}, white<FootLeft, 2>},
    {{"log-white", "hand_tip_x_mm", "mm", {6, 17}}, white<HandTipLeft, 0>},
    {{"log-white", "hand_tip_y_mm", "mm", {10, 19}}, white<HandTipLeft, 1>},
    {{"log-white", "hand_tip_z_mm", "mm", {9, 17}}, white<HandTipLeft, 2>},
    {{"log-white-inferred", "knee_x_mm", "mm", {14, 14}}, white_inferred<KneeLeft, 0>},
    {{"log-white-inferred", "knee_y_mm", "mm", {14, 14}}, white_inferred<KneeLeft, 1>},
    {{"log-white-inferred", "knee_z_mm", "mm", {14, 14}}, white_inferred<KneeLeft, 2>},
    {{"log-white-inferred", "wrist_x_mm", "mm", {6, 23}}, white_inferred<WristLeft, 0>},
    {{"log-white-inferred", "wrist_y_mm", "mm", {6, 23}}, white_inferred<WristLeft, 1>},
    {{"log-white-inferred", "wrist_z_mm", "mm", {6, 23}}, white_inferred<WristLeft, 2>},
    {{"log-white-inferred", "foot_x_mm", "mm", {9, 25}}, white_inferred<FootLeft, 0>},
    {{"log-white-inferred", "foot_y_mm", "mm", {9, 25}}, white_inferred<FootLeft, 1>},
    {{"log-white-inferred", "foot_z_mm", "mm", {9, 25}}, white_inferred<FootLeft, 2>},
    {{"log-bone-std", "lower_trunk_mm", "mm", {20, 25}}, bone<SpineMid>},
    {{"log-bone-std", "upper_trunk_mm", "mm", {13, 16}}, bone<SpineShoulder>},
    {{"log-bone-std", "chest_neck_mm", "mm", {4, 5}}, bone<Neck>},
    {{"log-bone-std", "neck_head_mm", "mm", {9, 12}}, bone<Head>},
    {{"log-bone-std", "shoulder_mm", "mm", {13, 24}}, either_bone<ShoulderLeft>},
    {{"log-bone-std", "upper_arm_mm", "mm", {24, 43}}, either_bone<ElbowLeft>},
    {{"log-bone-std", "forearm_mm", "mm", {28, 45}}, either_bone<WristLeft>},
    {{"log-bone-std", "thigh_mm", "mm", {40, 66}}, either_bone<KneeLeft>},
    {{"log-bone-std", "shank_mm", "mm", {41, 49}}, either_bone<AnkleLeft>},
    {{"log-bone-std", "hip_mm", "mm", {7, 14}}, either_bone<HipLeft>},
    {{"log-inferred", "wrist_percent", "%", {10, 30}}, either_inferred<WristLeft>},
    {{"log-inferred", "hand_percent", "%", {25, 50}}, either_inferred<HandLeft>},
    {{"log-inferred", "knee_percent", "%", {10, 20}}, either_inferred<KneeLeft>},
    {{"log-inferred", "ankle_percent", "%", {5, 30}}, either_inferred<AnkleLeft>},
    {{"log-inferred", "foot_percent", "%", {10, 45}}, either_inferred<FootLeft>},
    {{"log-inferred", "core_percent", "%", {0, 3}}, inferred<SpineMid>},
    {{"log-inferred", "neck_percent", "%", {0, 3}, 0.0}, inferred<Neck>},
    {{"log-autocorrelation", "next_frame", "", {0.75, 0.95, 1.0}}, next_frame<SpineShoulder>},
    {{"log-autocorrelation", "limb_next_frame", "", {0.75, 0.95, 1.0}}, next_frame<AnkleLeft>},
    {{"log-autocorrelation", "core_third_s", "", {0.63, 0.81, 1.0}}, third<SpineShoulder>},
    {{"log-autocorrelation", "arm_third_s", "", {0.26, 0.51, 1.0}}, third<ElbowLeft>},
    {{"log-autocorrelation", "forearm_third_s", "", {0.26, 0.51, 1.0}}, third<WristLeft>},
    {{"log-autocorrelation", "thigh_third_s", "", {0.4, 0.5, 1.0}}, third<KneeLeft>},
    {{"log-autocorrelation", "shank_third_s", "", {0.1, 0.2, 1.0}}, third<AnkleLeft>},
    {{"log-autocorrelation", "all_0.4_s", "", {0.2, 0.4, 1.0}}, later},
    {{"log-delivery", "step_median_ms", "ms", {33, 41}}, step<0>},
    {{"log-delivery", "step_95_ms", "ms", {33, 120}}, step<1>},
    {{"log-delivery", "longest_gap_ms", "ms", {2000, 6000}, kTolerance, true}, step<2>},
    {{"log-orientation", "joints_without", "", {7, 7}, 0.0}, unoriented},
};

constexpr LogClaim kTurned[] = {
    {{"log-turned-bone-std", "near_shoulder_mm", "mm", {3, 3}}, bone<ShoulderRight>},
    {{"log-turned-bone-std", "far_shoulder_mm", "mm", {43, 43}}, bone<ShoulderLeft>},
    {{"log-turned-bone-std", "near_upper_arm_mm", "mm", {16, 16}}, bone<ElbowRight>},
    {{"log-turned-bone-std", "far_upper_arm_mm", "mm", {34, 34}}, bone<ElbowLeft>},
    {{"log-turned-bone-std", "near_forearm_mm", "mm", {14, 14}}, bone<WristRight>},
    {{"log-turned-bone-std", "far_forearm_mm", "mm", {32, 32}}, bone<WristLeft>},
    {{"log-turned-inferred", "near_shoulder_percent", "%", {0, 3}, 0.0}, inferred<ShoulderRight>},
    {{"log-turned-inferred", "far_shoulder_percent", "%", {81, 81, 100}}, inferred<ShoulderLeft>},
};

}  // namespace

std::span<const LogClaim> walking_claims() { return kWalking; }
std::span<const LogClaim> turned_claims() { return kTurned; }

}  // namespace chorus::bench
