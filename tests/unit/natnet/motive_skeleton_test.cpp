// Motive's bones: the names that clients look for, the agreed rest pose, and a chain that ends
// where the joints are.
#include "fusion-server/natnet/motive_skeleton.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::natnet {
namespace {

using namespace outlet::testing;
using chorus::testing::RotationNear;
using chorus::testing::VectorNear;

constexpr double kExact = 1e-9;

/// Parents according to Motive's documentation of its skeleton.
const std::map<std::string, std::string> kParents{
    {"Ab", "Hip"},          {"Chest", "Ab"},        {"Neck", "Chest"},  {"Head", "Neck"},
    {"LShoulder", "Chest"}, {"LUArm", "LShoulder"}, {"LFArm", "LUArm"}, {"LHand", "LFArm"},
    {"RShoulder", "Chest"}, {"RUArm", "RShoulder"}, {"RFArm", "RUArm"}, {"RHand", "RFArm"},
    {"LThigh", "Hip"},      {"LShin", "LThigh"},    {"LFoot", "LShin"}, {"LToe", "LFoot"},
    {"RThigh", "Hip"},      {"RShin", "RThigh"},    {"RFoot", "RShin"}, {"RToe", "RFoot"}};

const std::map<std::string, JointId> kJoints{
    {"Hip", JointId::SpineBase},      {"Chest", JointId::SpineMid},
    {"Neck", JointId::SpineShoulder}, {"Head", JointId::Neck},
    {"LUArm", JointId::ShoulderLeft}, {"LFArm", JointId::ElbowLeft},
    {"LHand", JointId::WristLeft},    {"RUArm", JointId::ShoulderRight},
    {"RFArm", JointId::ElbowRight},   {"RHand", JointId::WristRight},
    {"LThigh", JointId::HipLeft},     {"LShin", JointId::KneeLeft},
    {"LFoot", JointId::AnkleLeft},    {"LToe", JointId::FootLeft},
    {"RThigh", JointId::HipRight},    {"RShin", JointId::KneeRight},
    {"RFoot", JointId::AnkleRight},   {"RToe", JointId::FootRight}};

using Named = std::map<std::string, MotiveBone>;

Named named(const outlet::TrackerBody& body, Coordinates coordinates) {
  const auto skeleton = motive_skeleton(body, coordinates);
  EXPECT_TRUE(skeleton);
  Named found;
  for (std::size_t i = 0; skeleton && i < kBoneCount; ++i) {
    found[std::string(motive_bones()[i].name)] = (*skeleton)[i];
  }
  return found;
}

/// Multiplies the bones along the chain, as clients do.
MotiveBone in_world(const Named& local, const std::string& bone) {
  const MotiveBone& own = local.at(bone);
  const auto parent = kParents.find(bone);
  if (parent == kParents.end()) return own;
  const MotiveBone above = in_world(local, parent->second);
  return {above.position + above.orientation * own.position, above.orientation * own.orientation,
          own.tracked};
}

/// T-pose looking along +z.
outlet::TrackerBody motive_t_pose() {
  outlet::TrackerBody body = t_pose();
  move(body, {0, 0, 0}, 180);
  return body;
}

TEST(MotiveSkeleton, HasTheHierarchyThatClientsKnow) {
  const auto& bones = motive_bones();
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const auto parent = kParents.find(std::string(bones[i].name));
    if (parent == kParents.end()) {
      EXPECT_EQ(bones[i].parent, 0) << bones[i].name;
    } else {
      ASSERT_GT(bones[i].parent, 0);
      EXPECT_EQ(bones[static_cast<std::size_t>(bones[i].parent - 1)].name, parent->second);
    }
  }
}

TEST(MotiveSkeleton, ATPoseThatLooksAlongZIsAtRest) {
  for (const auto& [name, bone] : named(motive_t_pose(), Coordinates::Local)) {
    EXPECT_TRUE(bone.tracked) << name;
    EXPECT_THAT(bone.orientation, RotationNear(Eigen::Quaterniond::Identity(), 1e-6)) << name;
  }
}

TEST(MotiveSkeleton, TheDescribedRestIsThatTPose) {
  const Named rest = named(motive_t_pose(), Coordinates::Local);
  for (const BoneDescription& bone : motive_bones()) {
    const auto& [x, y, z] = bone.offset;
    EXPECT_THAT(rest.at(std::string(bone.name)).position,
                VectorNear(Eigen::Vector3d(x, y, z), 0.002))
        << bone.name;
  }
}

TEST(MotiveSkeleton, TheChainOfLocalBonesEndsWhereTheJointsAre) {
  const outlet::TrackerBody body = asymmetric_pose();
  const Named local = named(body, Coordinates::Local);
  const Named global = named(body, Coordinates::Global);
  for (const auto& [name, bone] : global) {
    const MotiveBone found = in_world(local, name);
    EXPECT_THAT(found.position, VectorNear(bone.position, kExact)) << name;
    EXPECT_THAT(found.orientation, RotationNear(bone.orientation, 1e-6)) << name;
    if (kJoints.contains(name)) {
      EXPECT_THAT(found.position, VectorNear(body[kJoints.at(name)].position, kExact)) << name;
    }
  }
}

TEST(MotiveSkeleton, ABoneTurnsItsOwnRestDirectionToItsChild) {
  const outlet::TrackerBody body = asymmetric_pose();
  const Named global = named(body, Coordinates::Global);
  const auto along = [&](const char* bone, const char* child) -> Eigen::Vector3d {
    return global.at(bone).orientation.conjugate() *
           (global.at(child).position - global.at(bone).position).normalized();
  };
  // Left is +x, forward is +z: with this asymmetric pose, mirrored or rotated axes would show.
  EXPECT_THAT(along("LUArm", "LFArm"), VectorNear(Eigen::Vector3d(1, 0, 0), 1e-6));
  EXPECT_THAT(along("RFArm", "RHand"), VectorNear(Eigen::Vector3d(-1, 0, 0), 1e-6));
  EXPECT_THAT(along("LThigh", "LShin"), VectorNear(Eigen::Vector3d(0, -1, 0), 1e-6));
  EXPECT_GT(along("RFoot", "RToe").z(), 0.8);
}

TEST(MotiveSkeleton, AYawTurnsTheHipOnly) {
  outlet::TrackerBody body = motive_t_pose();
  move(body, {1, 0, 2}, 30);
  const Named local = named(body, Coordinates::Local);
  EXPECT_THAT(local.at("Hip").orientation, RotationNear(about_up(30), 1e-6));
  EXPECT_THAT(local.at("LFArm").orientation, RotationNear(Eigen::Quaterniond::Identity(), 1e-6));
  EXPECT_THAT(local.at("Hip").position, VectorNear(Eigen::Vector3d(1, 0.95, 2), kExact));
}

TEST(MotiveSkeleton, AnUnseenLimbHangsAtRestAndWhatIsSeenBeyondItKeepsItsPlace) {
  outlet::TrackerBody body = asymmetric_pose();
  body.joints[index_of(JointId::ShoulderLeft)].tracked = false;
  const Named local = named(body, Coordinates::Local);
  EXPECT_FALSE(local.at("LUArm").tracked);
  EXPECT_THAT(local.at("LUArm").position, VectorNear(Eigen::Vector3d(0.126, -0.007, 0), kExact));
  EXPECT_THAT(local.at("LUArm").orientation, RotationNear(Eigen::Quaterniond::Identity(), kExact));
  EXPECT_TRUE(local.at("LFArm").tracked);
  EXPECT_THAT(in_world(local, "LFArm").position,
              VectorNear(body[JointId::ElbowLeft].position, kExact));
}

TEST(MotiveSkeleton, WhoFacesNowhereHasNone) {
  outlet::TrackerBody body = asymmetric_pose();
  body.joints[index_of(JointId::SpineBase)].tracked = false;
  EXPECT_FALSE(motive_skeleton(body, Coordinates::Local));
}

}  // namespace
}  // namespace chorus::natnet
