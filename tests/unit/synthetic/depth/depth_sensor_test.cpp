#include "common/synthetic/depth/depth_sensor.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::synthetic::depth {
namespace {

constexpr Timestamp kStart = from_unix_ns(1'795'000'000'000'000'000);
constexpr Timestamp kEnd = kStart + std::chrono::seconds(5);

Scene room() {
  WalkerScript script;
  script.centre = {0.0, 2.6};
  script.reach = 0.7;
  Scene scene;
  scene.epoch = kStart;
  scene.people = make_people(script, 1);
  scene.world_from_sensor = {stand_sensor({0, 1.2, 0}, 0.0, deg(5))};
  return scene;
}

DepthSetting setting(std::uint64_t seed = 1) {
  return {*SensorId::parse("s1"), 0, nominal_depth_profile(), seed, 1, true};
}

std::vector<SensorFrame> recorded(const Scene& scene, DepthSetting how) {
  DepthSensor sensor(scene, std::move(how), kStart);
  return record(sensor, kEnd);
}

std::vector<Eigen::Vector3d> joints_in(const std::vector<SensorFrame>& frames) {
  std::vector<Eigen::Vector3d> all;
  for (const SensorFrame& frame : frames) {
    for (const BodyFrame& body : frame.bodies) {
      for (const Joint& joint : body.skeleton.joints) all.push_back(joint.position);
    }
  }
  return all;
}

TEST(DepthSensor, TheSameSeedGivesTheSameFrames) {
  const Scene scene = room();
  const auto once = joints_in(recorded(scene, setting()));
  ASSERT_GT(once.size(), 100u * kJointCount);
  EXPECT_EQ(once, joints_in(recorded(scene, setting())));
  EXPECT_NE(once, joints_in(recorded(scene, setting(2))));
}

TEST(DepthSensor, GivesFiniteValuesInOrderWithTheHostsStamp) {
  const Scene scene = room();
  DepthSetting how = setting();
  how.profile.clock.offset = 0.2;
  DepthSensor sensor(scene, how, kStart);
  EXPECT_NE(sensor.clock().offset, 0.0);
  Timestamp before = kStart;
  while (sensor.next_exposure() <= kEnd) {
    const Timestamp exposed = sensor.next_exposure();
    ASSERT_GT(exposed, before);
    before = exposed;
    const auto frame = sensor.next();
    if (!frame) continue;
    EXPECT_EQ(frame->captured, sensor.clock().host_time(exposed));
    EXPECT_GT(frame->received, exposed);
    ASSERT_TRUE(frame->floor && frame->floor->normal.allFinite());
    for (const BodyFrame& body : frame->bodies) {
      EXPECT_EQ(body.captured, frame->captured);
      for (const Joint& joint : body.skeleton.joints) ASSERT_TRUE(joint.position.allFinite());
    }
  }
}

TEST(DepthSensor, DropsFramesAndCountsThem) {
  DepthSetting how = setting();
  how.profile.delivery.drop_share = 0.5;
  const auto frames = recorded(room(), how);
  EXPECT_NEAR(static_cast<double>(frames.size()), 75, 25);
  EXPECT_GT(frames.back().sequence - frames.front().sequence, frames.size() + 20);
}

TEST(DepthSensor, AWalkIsFollowed) {
  const Scene scene = room();
  DepthSetting how = setting();
  how.own_clock = false;
  double sum = 0;
  std::size_t count = 0;
  const auto frames = recorded(scene, how);
  for (const SensorFrame& frame : frames) {
    if (frame.bodies.empty()) continue;
    const auto exact =
        to_sensor(scene.world_from_sensor[0].inverse(), truth(scene, 0, frame.captured));
    for (const JointId id : {JointId::Neck, JointId::SpineShoulder, JointId::Head}) {
      sum += (frame.bodies[0].skeleton[id].position - exact[id].position).norm();
      ++count;
    }
  }
  EXPECT_GT(count, 9 * frames.size() / 4) << "three joints in most frames";
  EXPECT_LT(to_mm(sum / static_cast<double>(count)), 100);
  EXPECT_GT(to_mm(sum / static_cast<double>(count)), 5) << "not a perfect sensor";
}

TEST(DepthSensor, NobodyInAnEmptyRoom) {
  Scene scene = room();
  scene.people.clear();
  for (const SensorFrame& frame : recorded(scene, setting())) EXPECT_TRUE(frame.bodies.empty());
}

}  // namespace
}  // namespace chorus::synthetic::depth
