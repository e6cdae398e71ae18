// NatNet frames and model definitions, byte by byte according to the format's description.
#include "fusion-server/natnet/natnet_encoder.h"

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "fusion-server/natnet/natnet_messages.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/unit/natnet/natnet_reader.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::natnet {
namespace {

using chorus::testing::kStart;
using chorus::testing::RotationNear;
using chorus::testing::VectorNear;
using outlet::testing::asymmetric_pose;
using outlet::testing::NatNetReader;

constexpr double kFloat = 1e-6;

outlet::TrackerFrame frame_of(std::vector<outlet::TrackerBody> bodies) {
  outlet::TrackerFrame frame;
  frame.sequence = 0x1'8000'0007;  // more than the field holds
  frame.instant = kStart + std::chrono::milliseconds(1500);
  frame.slots = 6;
  frame.bodies = std::move(bodies);
  return frame;
}

outlet::TrackerBody in(std::size_t slot, outlet::TrackerBody body) {
  body.slot = slot;
  return body;
}

Times times() {
  return {kStart, kStart + std::chrono::milliseconds(1510),
          kStart + std::chrono::milliseconds(1511)};
}

TEST(NatNetFrame, HasTheLayoutOfVersion31) {
  NatNetReader read(encode_frame(frame_of({in(2, asymmetric_pose())}), {}, times()));
  EXPECT_EQ(read.one<std::uint16_t>(), 7);
  EXPECT_EQ(read.one<std::uint16_t>(), 4 * 4 + 25 * 38 + 4 + 8 + 21 * 38 + 12 + 8 + 8 + 24 + 2 + 4);
  EXPECT_EQ(read.one<std::int32_t>(), 7);
  EXPECT_EQ(read.one<std::uint32_t>(), 0u);  // marker sets
  EXPECT_EQ(read.one<std::uint32_t>(), 0u);  // other markers
  EXPECT_EQ(read.bodies().size(), kJointCount);
  ASSERT_EQ(read.one<std::uint32_t>(), 1u);  // skeletons
  EXPECT_EQ(read.one<std::int32_t>(), 3);
  const auto bones = read.bodies();
  ASSERT_EQ(bones.size(), kBoneCount);
  for (std::size_t i = 0; i < bones.size(); ++i) {
    EXPECT_EQ(bones[i].id, (3 << 16) + static_cast<int>(i) + 1);
  }
  for (int i = 0; i < 3; ++i) EXPECT_EQ(read.one<std::uint32_t>(), 0u);  // markers, plates, devices
  EXPECT_EQ(read.one<std::uint64_t>(), 0u);                              // timecode
  EXPECT_EQ(read.one<double>(), 1.5);
  const auto start = static_cast<std::uint64_t>(to_unix_ns(kStart));
  EXPECT_EQ(read.one<std::uint64_t>(), start + 1'500'000'000);
  EXPECT_EQ(read.one<std::uint64_t>(), start + 1'510'000'000);
  EXPECT_EQ(read.one<std::uint64_t>(), start + 1'511'000'000);
  EXPECT_EQ(read.one<std::int16_t>(), 0);
  EXPECT_EQ(read.one<std::uint32_t>(), 0u);
  EXPECT_TRUE(read.ended());
}

std::vector<NatNetReader::Body> rigid_bodies_of(const outlet::TrackerFrame& frame) {
  NatNetReader read(encode_frame(frame, {.skeletons = false}, times()));
  read.one<std::uint64_t>();
  read.one<std::uint64_t>();
  return read.bodies();
}

TEST(NatNetFrame, ARigidBodyIsTheJointAsItIs) {
  outlet::TrackerBody body = asymmetric_pose();
  body.joints[index_of(JointId::WristLeft)].orientation =
      outlet::testing::about_x(30) * outlet::testing::about_up(40) * outlet::testing::about_z(-70);
  const auto found = rigid_bodies_of(frame_of({in(1, body)}));
  ASSERT_EQ(found.size(), kJointCount);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    EXPECT_EQ(found[i].id, static_cast<int>(25 + i + 1));
    EXPECT_TRUE(found[i].tracked);
    EXPECT_THAT(found[i].place, VectorNear(body.joints[i].position, 1e-5));
    EXPECT_THAT(found[i].turned, RotationNear(body.joints[i].orientation, kFloat));
  }
}

TEST(NatNetFrame, AnUnseenJointSaysSoAndHangsOnTheNextThatIsSeen) {
  outlet::TrackerBody body = asymmetric_pose();
  for (const JointId id : {JointId::HandRight, JointId::HandTipRight}) {
    body.joints[index_of(id)].tracked = false;
    body.joints[index_of(id)].position.setConstant(std::nan(""));
  }
  const auto found = rigid_bodies_of(frame_of({in(0, body)}));
  for (const JointId id : {JointId::HandRight, JointId::HandTipRight}) {
    EXPECT_FALSE(found.at(index_of(id)).tracked);
    EXPECT_THAT(found.at(index_of(id)).place, VectorNear(body[JointId::WristRight].position, 1e-5));
  }
  EXPECT_TRUE(found.at(index_of(JointId::WristRight)).tracked);
}

TEST(NatNetFrame, ABodyOfWhichNothingIsSeenIsFinite) {
  outlet::TrackerBody body;
  for (outlet::TrackerJoint& joint : body.joints) joint.position.setConstant(std::nan(""));
  NatNetReader read(encode_frame(frame_of({body}), {}, times()));
  read.one<std::uint64_t>();
  read.one<std::uint64_t>();
  for (const auto& each : read.bodies()) {
    EXPECT_FALSE(each.tracked);
    EXPECT_THAT(each.place, VectorNear(Eigen::Vector3d(0, 0, 0), 0.0));
  }
  EXPECT_EQ(read.one<std::uint32_t>(), 0u);  // no known facing: no skeleton
}

TEST(NatNetFrame, SaysThatModelsHaveChanged) {
  const Bytes before = encode_frame(frame_of({}), {}, times());
  const Bytes after = encode_frame(frame_of({}), {}, times(), true);
  const std::size_t params = before.size() - 6;
  EXPECT_EQ(number_at<std::uint16_t>(before, params), 0u);
  EXPECT_EQ(number_at<std::uint16_t>(after, params), 2u) << "tracked models changed";
}

TEST(NatNetFrame, NobodyIsAFrameToo) {
  const Bytes bytes = encode_frame(frame_of({}), {}, times());
  EXPECT_EQ(bytes.size(), 4u + 8 * 4 + 8 + 8 + 24 + 2 + 4);
}

TEST(NatNetFrame, WhatIsSwitchedOffIsNotThere) {
  const outlet::TrackerFrame frame = frame_of({in(0, asymmetric_pose())});
  const std::size_t empty = encode_frame(frame_of({}), {}, times()).size();
  EXPECT_EQ(encode_frame(frame, {false, false, Coordinates::Local}, times()).size(), empty);
  EXPECT_EQ(encode_frame(frame, {true, false, Coordinates::Local}, times()).size(),
            empty + 25 * 38);
  EXPECT_EQ(encode_frame(frame, {false, true, Coordinates::Local}, times()).size(),
            empty + 8 + 21 * 38);
}

TEST(NatNet, TheMostPersonsFitIntoADatagram) {
  constexpr std::size_t kMaxDatagram = 65507;
  std::vector<outlet::TrackerBody> bodies;
  for (std::size_t slot = 0; slot < outlet::kMaxSlots; ++slot)
    bodies.push_back(in(slot, asymmetric_pose()));
  EXPECT_LT(encode_frame(frame_of(std::move(bodies)), {}, times()).size(), kMaxDatagram);
  EXPECT_LT(encode_models(outlet::kMaxSlots, {}).size(), kMaxDatagram);
}

TEST(NatNetModels, DescribeEverySlotBeforehand) {
  NatNetReader read(encode_models(2, {}));
  EXPECT_EQ(read.one<std::uint16_t>(), 5);
  read.one<std::uint16_t>();
  ASSERT_EQ(read.one<std::uint32_t>(), 2u * 26);
  for (int slot = 0; slot < 2; ++slot) {
    const std::string body = "Body" + std::to_string(slot);
    for (std::size_t i = 0; i < kJointCount; ++i) {
      EXPECT_EQ(read.one<std::uint32_t>(), 1u);
      EXPECT_EQ(read.text(), body + "_" + std::string(kJointNames[i]));
      EXPECT_EQ(read.one<std::int32_t>(), 25 * slot + static_cast<int>(i) + 1);
      EXPECT_EQ(read.one<std::int32_t>(), -1);
      EXPECT_EQ(read.vector(), Eigen::Vector3d(0, 0, 0));
      EXPECT_EQ(read.one<std::uint32_t>(), 0u);
    }
    EXPECT_EQ(read.one<std::uint32_t>(), 2u);
    EXPECT_EQ(read.text(), body);
    EXPECT_EQ(read.one<std::int32_t>(), slot + 1);
    ASSERT_EQ(read.one<std::uint32_t>(), kBoneCount);
    for (std::size_t i = 0; i < kBoneCount; ++i) {
      EXPECT_TRUE(read.text().starts_with(body + "_"));
      EXPECT_EQ(read.one<std::int32_t>(), static_cast<int>(i) + 1);
      EXPECT_LE(read.one<std::int32_t>(), static_cast<int>(i));  // parents come first
      read.vector();
      EXPECT_EQ(read.one<std::uint32_t>(), 0u);
    }
  }
  EXPECT_TRUE(read.ended());
}

TEST(NatNetModels, HaveTheBonesThatWereMeasured) {
  std::vector<BoneOffsets> bones(1, adult_offsets());
  bones[0][1] = {0.25, 0.5, 0.75};
  NatNetReader read(encode_models(2, {false, true, Coordinates::Local}, bones));
  read.one<std::uint64_t>();
  for (const Eigen::Vector3d& second :
       {Eigen::Vector3d(0.25, 0.5, 0.75), Eigen::Vector3d(0, 0.083, 0)}) {
    read.one<std::uint32_t>();
    read.text();
    read.one<std::uint64_t>();
    for (std::size_t i = 0; i < kBoneCount; ++i) {
      read.text();
      read.one<std::uint64_t>();
      const Eigen::Vector3d offset = read.vector();
      if (i == 1) {
        EXPECT_THAT(offset, VectorNear(second, kFloat));
      }
      read.one<std::uint32_t>();
    }
  }
  EXPECT_TRUE(read.ended());
}

TEST(NatNet, ThingsInHandsAreRigidBodiesBehindThoseOfAllSlots) {
  outlet::TrackerFrame frame = frame_of({in(2, asymmetric_pose())});
  frame.props = {{"box", 2, {}}};
  frame.props[0].pose.position = {1, 2, 3};
  frame.props[0].pose.tracked = true;
  NatNetReader read(encode_frame(frame, {}, times()));
  for (int i = 0; i < 2; ++i) read.one<std::uint16_t>();
  for (int i = 0; i < 3; ++i) read.one<std::uint32_t>();
  const auto bodies = read.bodies();
  ASSERT_EQ(bodies.size(), kJointCount + 1);
  EXPECT_EQ(bodies.back().id, 6 * 25 + 1);
  EXPECT_THAT(bodies.back().place, VectorNear(Eigen::Vector3d(1, 2, 3), kFloat));
  const Bytes models = encode_models(6, {}, {}, {"box"});
  EXPECT_NE(std::string(models.begin(), models.end()).find(std::string("box\0\x97", 5)),
            std::string::npos);
  EXPECT_EQ(encode_models(6, {.rigid_bodies = false}, {}, {"box"}),
            encode_models(6, {.rigid_bodies = false}));
}

}  // namespace
}  // namespace chorus::natnet
