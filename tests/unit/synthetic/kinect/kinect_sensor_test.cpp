#include "common/synthetic/kinect/kinect_sensor.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/builders.h"
#include "tests/unit/synthetic/kinect/room.h"

namespace chorus::synthetic::kinect {
namespace {

std::vector<SensorFrame> minute(const Scene& scene, const KinectSetting& how) {
  return record(scene, how, kStart, kStart + std::chrono::seconds(60));
}

bool same(const std::vector<SensorFrame>& a, const std::vector<SensorFrame>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].captured != b[i].captured || a[i].received != b[i].received ||
        a[i].bodies.size() != b[i].bodies.size())
      return false;
    for (std::size_t body = 0; body < a[i].bodies.size(); ++body) {
      for (std::size_t j = 0; j < kJointCount; ++j) {
        const Joint& one = a[i].bodies[body].skeleton.joints[j];
        const Joint& other = b[i].bodies[body].skeleton.joints[j];
        if (one.position != other.position || one.state != other.state) return false;
      }
    }
  }
  return true;
}

TEST(KinectSensor, TheSameSeedGivesTheSameFrames) {
  const Profile profile = nominal_profile("A");
  const auto once = minute(room(2), setting(profile));
  EXPECT_TRUE(same(once, minute(room(2), setting(profile))));
  EXPECT_FALSE(same(once, minute(room(2), setting(profile, 2))));
  EXPECT_FALSE(same(once, minute(room(2), setting(profile, 1, 1))));
}

TEST(KinectSensor, GivesFiniteValuesInOrderForBothProfiles) {
  for (const char* name : {"A", "B"}) {
    const auto frames = minute(room(3), setting(draw_profile(name, 4)));
    ASSERT_GT(frames.size(), 1600u);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ASSERT_TRUE(i == 0 || frames[i].captured > frames[i - 1].captured);
      ASSERT_GT(frames[i].received, frames[i].captured);
      ASSERT_TRUE(frames[i].floor && frames[i].floor->normal.allFinite());
      for (const BodyFrame& body : frames[i].bodies) {
        for (const Joint& joint : body.skeleton.joints) ASSERT_TRUE(joint.position.allFinite());
      }
    }
  }
}

TEST(KinectSensor, ErrorIsThatOfARealSensorAndNotOfAPerfectOne) {
  const Scene scene = room();
  KinectSetting how = setting(nominal_profile("A"));
  how.own_clock = false;
  double sum = 0;
  std::size_t count = 0;
  for (const SensorFrame& frame : minute(scene, how)) {
    if (frame.bodies.empty()) continue;
    const auto exact =
        to_sensor(scene.world_from_sensor[0].inverse(), truth(scene, 0, frame.captured));
    for (const JointId id : {JointId::Neck, JointId::SpineShoulder, JointId::SpineMid}) {
      sum += (frame.bodies[0].skeleton[id].position - exact[id].position).norm();
      ++count;
    }
  }
  EXPECT_GT(sum / static_cast<double>(count), mm(5));
  EXPECT_LT(sum / static_cast<double>(count), mm(60));
}

TEST(KinectSensor, TheSideTurnedAwayErrsMoreThanTheOtherAndIsMostlyGuessed) {
  Scene scene = room();
  scene.people = {[](Duration) {
    return testing::standing_person({0, 0, 2.0}, deg(180) + deg(75));
  }};
  Profile profile = nominal_profile("A");
  for (const Source source : {Source::Bias, Source::Yaw, Source::Gross})
    profile = with_source(std::move(profile), source, 0.0);
  KinectSetting how = setting(profile);
  how.own_clock = false;
  const auto exact = to_sensor(scene.world_from_sensor[0].inverse(), truth(scene, 0, kStart));
  using enum JointId;
  const bool left_far = exact[ShoulderLeft].position.z() > exact[ShoulderRight].position.z();
  std::array<double, 2> error{};    // near, far
  std::array<double, 2> guessed{};  // near, far
  for (const SensorFrame& frame : minute(scene, how)) {
    if (frame.bodies.empty()) continue;
    for (const JointId id : {ShoulderLeft, ShoulderRight}) {
      const std::size_t side = (id == ShoulderLeft) == left_far ? 1 : 0;
      const Joint& joint = frame.bodies[0].skeleton[id];
      error[side] += (joint.position - exact[id].position).squaredNorm();
      guessed[side] += joint.state == JointState::Inferred;
    }
  }
  EXPECT_GT(std::sqrt(error[1]), 1.5 * std::sqrt(error[0]));
  EXPECT_EQ(guessed[0], 0);
  EXPECT_GT(guessed[1], 900) << "of 1800";
}

TEST(KinectSensor, SensorsAndPeopleHaveTheirOwnIds) {
  const auto one = minute(room(2), setting(nominal_profile("A")));
  std::set<std::uint64_t> ids;
  for (const SensorFrame& frame : one) {
    std::set<std::uint64_t> here;
    for (const BodyFrame& body : frame.bodies) {
      EXPECT_TRUE(here.insert(body.id.value).second) << "twice in one frame";
      ids.insert(body.id.value);
    }
  }
  EXPECT_GE(ids.size(), 2u);
}

TEST(KinectSensor, AnOccluderBetweenMakesItLoseThePerson) {
  Scene scene = room();
  const auto free = minute(scene, setting(nominal_profile("A")));
  Occluder wall;
  wall.world_from_box.translation() = Eigen::Vector3d(0, 1, 1.2);
  wall.half = {2, 2, 0.05};
  scene.occluders = {wall};
  const auto hidden = minute(scene, setting(nominal_profile("A")));
  const auto bodies = [](const std::vector<SensorFrame>& frames) {
    std::size_t count = 0;
    for (const SensorFrame& frame : frames) count += frame.bodies.size();
    return count;
  };
  EXPECT_LT(bodies(hidden), bodies(free) / 2);
}

TEST(KinectSensor, NobodyInAnEmptyRoom) {
  Scene scene = room();
  scene.people.clear();
  Profile profile = with_source(nominal_profile("A"), Source::Gross, 0.0);
  for (const SensorFrame& frame : minute(scene, setting(profile))) {
    EXPECT_TRUE(frame.bodies.empty());
  }
}

}  // namespace
}  // namespace chorus::synthetic::kinect
