// VMC's bone rotations, multiplied along the chain, give the original joints.
#include "fusion-server/osc/vmc_encoder.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/unit/osc/osc_reader.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::vmc {
namespace {

using namespace outlet::testing;
using chorus::testing::RotationNear;
using chorus::testing::VectorNear;

struct Pose {
  Eigen::Vector3d p;
  Eigen::Quaterniond q;
};

/// Unity's humanoid hierarchy, written down from Unity's manual.
const std::map<std::string, std::string> kUnityParents{{"Spine", "Hips"},
                                                       {"Chest", "Spine"},
                                                       {"UpperChest", "Chest"},
                                                       {"Neck", "UpperChest"},
                                                       {"Head", "Neck"},
                                                       {"LeftShoulder", "UpperChest"},
                                                       {"LeftUpperArm", "LeftShoulder"},
                                                       {"LeftLowerArm", "LeftUpperArm"},
                                                       {"LeftHand", "LeftLowerArm"},
                                                       {"RightShoulder", "UpperChest"},
                                                       {"RightUpperArm", "RightShoulder"},
                                                       {"RightLowerArm", "RightUpperArm"},
                                                       {"RightHand", "RightLowerArm"},
                                                       {"LeftUpperLeg", "Hips"},
                                                       {"LeftLowerLeg", "LeftUpperLeg"},
                                                       {"LeftFoot", "LeftLowerLeg"},
                                                       {"LeftToes", "LeftFoot"},
                                                       {"RightUpperLeg", "Hips"},
                                                       {"RightLowerLeg", "RightUpperLeg"},
                                                       {"RightFoot", "RightLowerLeg"},
                                                       {"RightToes", "RightFoot"}};

using Poses = std::map<std::string, Pose>;

Poses poses_at(const std::vector<OscMessage>& messages, const std::string& address) {
  Poses poses;
  for (const OscMessage& m : messages) {
    if (m.address != address) continue;
    EXPECT_EQ(m.types, "sfffffff");
    const auto& n = m.numbers;
    poses[m.texts.at(0)] = {{n.at(0), n.at(1), n.at(2)}, {n.at(6), n.at(3), n.at(4), n.at(5)}};
  }
  return poses;
}

Pose in_world(const Poses& local, const std::string& bone) {
  const Pose& own = local.at(bone);
  const auto parent = kUnityParents.find(bone);
  if (parent == kUnityParents.end()) return own;
  const Pose above = in_world(local, parent->second);
  return {above.p + above.q * own.p, above.q * own.q};
}

Eigen::Vector3d to_unity(const Eigen::Vector3d& x) { return {x.x(), x.y(), -x.z()}; }

const std::map<std::string, JointId> kJointsOfBones{{"Hips", JointId::SpineBase},
                                                    {"Chest", JointId::SpineMid},
                                                    {"Neck", JointId::SpineShoulder},
                                                    {"Head", JointId::Neck},
                                                    {"LeftUpperArm", JointId::ShoulderLeft},
                                                    {"LeftLowerArm", JointId::ElbowLeft},
                                                    {"LeftHand", JointId::WristLeft},
                                                    {"RightUpperArm", JointId::ShoulderRight},
                                                    {"RightLowerArm", JointId::ElbowRight},
                                                    {"RightHand", JointId::WristRight},
                                                    {"LeftUpperLeg", JointId::HipLeft},
                                                    {"LeftLowerLeg", JointId::KneeLeft},
                                                    {"LeftFoot", JointId::AnkleLeft},
                                                    {"LeftToes", JointId::FootLeft},
                                                    {"RightUpperLeg", JointId::HipRight},
                                                    {"RightLowerLeg", JointId::KneeRight},
                                                    {"RightFoot", JointId::AnkleRight},
                                                    {"RightToes", JointId::FootRight}};

TEST(Vmc, TheChainOfBonesEndsAtTheJoints) {
  const outlet::TrackerBody body = asymmetric_pose();
  const Poses bones = poses_at(read_osc(encode(&body, {})), "/VMC/Ext/Bone/Pos");
  ASSERT_EQ(bones.size(), 22u);
  for (const auto& [bone, joint] : kJointsOfBones) {
    EXPECT_THAT(in_world(bones, bone).p, VectorNear(to_unity(body[joint].position), 1e-5)) << bone;
  }
  const Eigen::Vector3d hips(1, 2.95, 3);
  EXPECT_THAT(bones.at("Hips").p, VectorNear(to_unity(hips), 1e-5));
}

TEST(Vmc, BonesPointAtTheNextJointInUnitysAxes) {
  const outlet::TrackerBody body = asymmetric_pose();
  const Poses bones = poses_at(read_osc(encode(&body, {})), "/VMC/Ext/Bone/Pos");
  const Eigen::Vector3d along =
      to_unity(body[JointId::WristLeft].position - body[JointId::ElbowLeft].position).normalized();
  // In Unity a person in T-pose looks along +z and has the left hand at -x.
  EXPECT_THAT(in_world(bones, "LeftLowerArm").q * Eigen::Vector3d(-1, 0, 0),
              VectorNear(along, 1e-5));
}

TEST(Vmc, ATPoseIsAllIdentities) {
  const outlet::TrackerBody body = t_pose();
  const Poses bones = poses_at(read_osc(encode(&body, {})), "/VMC/Ext/Bone/Pos");
  ASSERT_EQ(bones.size(), 22u);
  for (const auto& [name, pose] : bones) {
    EXPECT_THAT(pose.q, RotationNear(Eigen::Quaterniond::Identity(), 1e-6)) << name;
  }
}

TEST(Vmc, KnownTurnsAreUnitysTurns) {
  outlet::TrackerBody body = t_pose();
  turn(body, kLeftArm, JointId::ShoulderLeft, about_z(90));
  turn(body, kRightArm, JointId::ShoulderRight, about_up(90));
  move(body, {0, 0, 0}, 30);
  const Poses bones = poses_at(read_osc(encode(&body, {})), "/VMC/Ext/Bone/Pos");
  EXPECT_THAT(bones.at("LeftUpperArm").q, RotationNear(about_z(90), 1e-6));     // hangs down
  EXPECT_THAT(bones.at("RightUpperArm").q, RotationNear(about_up(-90), 1e-6));  // points forwards
  // A yaw of 30 deg, in left-handed axes.
  EXPECT_THAT(bones.at("Hips").q, RotationNear(about_up(-30), 1e-6));
}

TEST(Vmc, SaysThatItIsCalibratedWhenAndThatTheRootStands) {
  const outlet::TrackerBody body = t_pose();
  const auto messages = read_osc(encode(&body, {12.5, false}));
  EXPECT_EQ(messages.at(0).address, "/VMC/Ext/OK");
  EXPECT_EQ(messages.at(0).types, "iiii");
  EXPECT_EQ(messages.at(0).numbers, (std::vector<double>{1, 3, 0, 1}));
  EXPECT_EQ(messages.at(1).address, "/VMC/Ext/T");
  EXPECT_EQ(messages.at(1).numbers, (std::vector<double>{12.5}));
  const Poses root = poses_at(messages, "/VMC/Ext/Root/Pos");
  EXPECT_EQ(root.at("root").p.norm(), 0.0);
  EXPECT_EQ(root.at("root").q.w(), 1.0);
}

TEST(Vmc, WithoutABodyOnlyTheStateIsSent) {
  for (const bool empty_slot : {true, false}) {
    const outlet::TrackerBody nowhere;  // nothing tracked
    const auto messages = read_osc(encode(empty_slot ? nullptr : &nowhere, {}));
    ASSERT_EQ(messages.size(), 2u);
    EXPECT_EQ(messages.at(0).numbers, (std::vector<double>{1, 3, 0, 0}));
  }
}

TEST(Vmc, TheLastWordIsThatNothingIsLoaded) {
  const auto messages = read_osc(encode_end());
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages.at(0).address, "/VMC/Ext/OK");
  EXPECT_EQ(messages.at(0).types, "iiii");
  EXPECT_EQ(messages.at(0).numbers, (std::vector<double>{0, 0, 0, 0}));
}

TEST(Vmc, TrackersArePosesInTheWorld) {
  const outlet::TrackerBody body = asymmetric_pose();
  EXPECT_TRUE(poses_at(read_osc(encode(&body, {})), "/VMC/Ext/Tra/Pos").empty());
  const auto messages = read_osc(encode(&body, {0, true}));
  const Poses trackers = poses_at(messages, "/VMC/Ext/Tra/Pos");
  const Poses bones = poses_at(messages, "/VMC/Ext/Bone/Pos");
  ASSERT_EQ(trackers.size(), 11u);
  EXPECT_THAT(trackers.at("LeftFoot").p,
              VectorNear(to_unity(body[JointId::AnkleLeft].position), 1e-5));
  EXPECT_THAT(trackers.at("LeftFoot").q, RotationNear(in_world(bones, "LeftFoot").q, 1e-5));
}

TEST(Vmc, DatagramsFitAnEthernetFrame) {
  const outlet::TrackerBody body = asymmetric_pose();
  const auto datagrams = encode(&body, {0, true});
  EXPECT_EQ(datagrams.size(), 2u);
  for (const auto& datagram : datagrams) EXPECT_LE(datagram.size(), 1400u);
}

TEST(Vmc, AnUntrackedArmIsLeftOutAndNothingIsNotANumber) {
  outlet::TrackerBody body = asymmetric_pose();
  body.joints[index_of(JointId::ElbowLeft)].tracked = false;
  body.joints[index_of(JointId::ElbowLeft)].position.setConstant(std::nan(""));
  const auto messages = read_osc(encode(&body, {0, true}));
  const Poses bones = poses_at(messages, "/VMC/Ext/Bone/Pos");
  EXPECT_FALSE(bones.contains("LeftUpperArm") || bones.contains("LeftLowerArm"));
  EXPECT_TRUE(bones.contains("LeftHand") && bones.contains("RightUpperArm"));
  for (const OscMessage& m : messages) {
    for (const double number : m.numbers) EXPECT_TRUE(std::isfinite(number)) << m.address;
  }
}

TEST(Vmc, ThingsInHandsAreTrackersByTheirNames) {
  const outlet::TrackerBody body = asymmetric_pose();
  const outlet::TrackerProp box{"box", 0, {.position = {1, 2, 3}, .tracked = true}};
  const auto messages = read_osc(encode(&body, {0, false, {&box}}));
  const Poses trackers = poses_at(messages, "/VMC/Ext/Tra/Pos");
  ASSERT_EQ(trackers.size(), 1u);
  EXPECT_THAT(trackers.at("box").p, VectorNear(Eigen::Vector3d(1, 2, -3), 1e-5));
}

}  // namespace
}  // namespace chorus::vmc
