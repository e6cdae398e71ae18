// Bodies that cannot be a person's.
#include "fusion-server/associate/plausible.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

using std::chrono::milliseconds;
using testing::kStart;

Skeleton<SensorSpace> person() {
  return testing::body_seen_from(testing::ring_sensor(0, 6), testing::standing_person(), kStart)
      .skeleton;
}

template <class Change>
Skeleton<SensorSpace> changed(const Change& change) {
  auto body = person();
  for (Joint& joint : body.joints) change(joint.position);
  return body;
}

TEST(Implausible, APersonIsNot) { EXPECT_EQ(implausible(person(), {}), ""); }

TEST(Implausible, TooFarTooLargeAndTooSmallAreSaid) {
  const auto far = changed([](auto& p) { p.z() += 9999.9; });
  EXPECT_NE(implausible(far, {}).find("max_range_m"), std::string_view::npos);
  const auto giant = changed([](auto& p) { p *= 3.0; });
  EXPECT_NE(implausible(giant, {}).find("larger"), std::string_view::npos);
  const auto doll = changed([](auto& p) { p = 0.05 * p + Eigen::Vector3d(0, 0, 2); });
  EXPECT_NE(implausible(doll, {}).find("smaller"), std::string_view::npos);
  Skeleton<SensorSpace> nobody;
  EXPECT_EQ(implausible(nobody, {}), "");
}

SensorFrame frame_at(Duration t, double shift) {
  BodyFrame body{BodyId{1}, kStart + t, person()};
  body.skeleton[JointId::Neck].position.x() += shift;
  return testing::sensor_frame("s1", kStart + t, {body});
}

TEST(FrozenBodies, AreThoseThatRepeatEveryDigitForSeconds) {
  FrozenBodies watch;
  std::size_t removed = 0;
  for (int ms = 0; ms <= 4000; ms += 33) {
    SensorFrame frame = frame_at(milliseconds(ms), 0.0);
    const std::size_t now = watch.remove_from(frame, {});
    EXPECT_EQ(now > 0, ms > 2000) << ms;
    EXPECT_EQ(frame.bodies.empty(), now > 0);
    removed += now;
  }
  EXPECT_GT(removed, 50u);
  SensorFrame moved = frame_at(milliseconds(4033), 0.0001);
  EXPECT_EQ(watch.remove_from(moved, {}), 0u);
}

TEST(FrozenBodies, APersonWhoStandsStillIsNone) {
  FrozenBodies watch;
  for (int i = 0; i < 300; ++i) {
    SensorFrame frame = frame_at(milliseconds(33 * i), i % 2 == 0 ? 0.0 : 0.0001);
    EXPECT_EQ(watch.remove_from(frame, {}), 0u) << i;
  }
}

TEST(FrozenBodies, RaysThatMoveAreNotFrozen) {
  FrozenBodies watch;
  for (int i = 0; i < 200; ++i) {
    SensorFrame frame;
    frame.captured = from_unix_ns(1'790'000'000'000'000'000) + std::chrono::milliseconds(33 * i);
    BodyFrame& body = frame.bodies.emplace_back();
    Joint& neck = body.skeleton[JointId::Neck];
    neck.position = Eigen::Vector3d(0.001 * i, 0, 1).normalized();
    neck.state = JointState::Tracked;
    neck.measurement = Measurement::Ray;
    ASSERT_EQ(watch.remove_from(frame, {}), 0u) << i;
  }
}

}  // namespace
}  // namespace chorus::associate
