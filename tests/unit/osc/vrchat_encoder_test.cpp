// VRChat's trackers: their numbers, their positions, and the rotations of their Euler angles.
#include "fusion-server/osc/vrchat_encoder.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/unit/osc/osc_reader.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::vrchat {
namespace {

using namespace outlet::testing;
using chorus::testing::RotationNear;
using chorus::testing::VectorNear;
using Vectors = std::map<std::string, Eigen::Vector3d>;

Vectors read(const outlet::TrackerBody& body, const Content& content = {}) {
  Vectors all;
  for (const auto& datagram : encode(body, content)) {
    const auto messages = OscReader(datagram).packet();
    EXPECT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages.at(0).types, "fff");
    const auto& n = messages.at(0).numbers;
    all[messages.at(0).address] = {n.at(0), n.at(1), n.at(2)};
  }
  return all;
}

/// The rotation that Unity's Euler angles [deg] describe: about z, then x, then y.  Unity is
/// left-handed, but right-handed matrices have the same form.
Eigen::Quaterniond unity_euler(const Eigen::Vector3d& degrees) {
  return about_up(degrees.y()) * about_x(degrees.x()) * about_z(degrees.z());
}

TEST(VrChat, TrackersHaveSlimeVrsNumbers) {
  const outlet::TrackerBody body = asymmetric_pose();
  const Vectors all = read(body);
  ASSERT_EQ(all.size(), 18u);
  const std::map<std::string, JointId> places{
      {"1", JointId::SpineBase}, {"2", JointId::AnkleLeft},  {"3", JointId::AnkleRight},
      {"4", JointId::KneeLeft},  {"5", JointId::KneeRight},  {"6", JointId::SpineMid},
      {"7", JointId::ElbowLeft}, {"8", JointId::ElbowRight}, {"head", JointId::Neck}};
  for (const auto& [name, joint] : places) {
    const Eigen::Vector3d& x = body[joint].position;
    EXPECT_THAT(all.at("/tracking/trackers/" + name + "/position"),
                VectorNear(Eigen::Vector3d(x.x(), x.y(), -x.z()), 1e-5))
        << name;
  }
}

TEST(VrChat, ATrackerCanBeAThingInThePersonsHands) {
  const outlet::TrackerBody body = asymmetric_pose();
  outlet::TrackerProp driver{"driver", 0, {}};
  driver.pose.position = {0.1, 1.2, 0.3};
  driver.pose.orientation = about_up(30);
  driver.pose.tracked = true;
  const Vectors held = read(body, {true, {{8, "driver"}}, {&driver}});
  ASSERT_EQ(held.size(), 18u);
  EXPECT_THAT(held.at("/tracking/trackers/8/position"),
              VectorNear(Eigen::Vector3d(0.1, 1.2, -0.3), 1e-5));
  EXPECT_THAT(held.at("/tracking/trackers/8/rotation"),
              VectorNear(Eigen::Vector3d(0, -30, 0), 1e-4));
  const Vectors empty_handed = read(body, {true, {{8, "driver"}}, {}});
  EXPECT_EQ(empty_handed.size(), 16u);
  EXPECT_FALSE(empty_handed.contains("/tracking/trackers/8/position")) << "no elbow instead";
}

TEST(VrChat, AnglesTurnTheTPoseIntoThePose) {
  const outlet::TrackerBody body = asymmetric_pose();
  const Vectors all = read(body);
  const auto seen_along = [&](JointId from, JointId to) {
    const Eigen::Vector3d d = (body[to].position - body[from].position).normalized();
    return Eigen::Vector3d(d.x(), d.y(), -d.z());
  };
  EXPECT_THAT(unity_euler(all.at("/tracking/trackers/7/rotation")) * Eigen::Vector3d(-1, 0, 0),
              VectorNear(seen_along(JointId::ShoulderLeft, JointId::ElbowLeft), 1e-5));
  EXPECT_THAT(unity_euler(all.at("/tracking/trackers/4/rotation")) * Eigen::Vector3d(0, -1, 0),
              VectorNear(seen_along(JointId::HipLeft, JointId::KneeLeft), 1e-5));
  EXPECT_THAT(unity_euler(all.at("/tracking/trackers/6/rotation")) * Eigen::Vector3d(0, 1, 0),
              VectorNear(seen_along(JointId::SpineMid, JointId::SpineShoulder), 1e-5));
}

TEST(VrChat, ATurnToTheLeftIsANegativeYaw) {
  outlet::TrackerBody body = t_pose();
  move(body, {0, 0, 0}, 30);
  EXPECT_THAT(read(body).at("/tracking/trackers/1/rotation"),
              VectorNear(Eigen::Vector3d(0, -30, 0), 1e-4));
}

TEST(VrChat, TheHeadIsOptionalAndUntrackedJointsAreLeftOut) {
  outlet::TrackerBody body = t_pose();
  body.joints[index_of(JointId::AnkleRight)].tracked = false;
  const Vectors all = read(body, {false});
  EXPECT_EQ(all.size(), 14u);  // 9 trackers, but not the head and not 3
  EXPECT_FALSE(all.contains("/tracking/trackers/head/position"));
  EXPECT_FALSE(all.contains("/tracking/trackers/3/rotation"));
  EXPECT_TRUE(read(outlet::TrackerBody{}).empty());
}

}  // namespace
}  // namespace chorus::vrchat
