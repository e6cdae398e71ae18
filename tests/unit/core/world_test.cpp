// The world stays where people have put it.
#include "fusion-server/core/world.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::core {
namespace {

constexpr int kRing = 5;

SensorId named_sensor(int i) { return testing::sensor_id("s" + std::to_string(i)); }

Eigen::Isometry3d along_the_floor(double x, double z, double yaw) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translation() = Eigen::Vector3d(x, 0.0, z);
  out.linear() = about_y(yaw).toRotationMatrix();
  return out;
}

/// Sensors of the ring in a world moved by `world_from_ring`; the first is the master.
Registration world_ring(std::vector<int> members,
                        const Eigen::Isometry3d& world_from_ring = Eigen::Isometry3d::Identity()) {
  Registration r;
  r.master = named_sensor(members.front());
  for (const int i : members)
    r.sensors[named_sensor(i)].world_from_sensor =
        world_from_ring * testing::ring_sensor(i - 1, kRing);
  return r;
}

double apart(const Registration& a, const Registration& b, int i) {
  const auto difference = a.sensors.at(named_sensor(i)).world_from_sensor.inverse() *
                          b.sensors.at(named_sensor(i)).world_from_sensor;
  return difference.translation().norm() + Eigen::AngleAxisd(difference.linear()).angle();
}

const Eigen::Isometry3d kElsewhere = along_the_floor(3.0, -7.0, 2.5);

TEST(World, AnotherMastersIsMovedIntoTheOneBefore) {
  const Registration before = world_ring({1, 2, 3});
  const Registration after = in_world_of(anchors_of(before), world_ring({3, 1, 2, 4}, kElsewhere));
  for (const int i : {1, 2, 3}) EXPECT_LT(apart(before, after, i), 1e-9) << i;
  EXPECT_LT(apart(world_ring({4}), after, 4), 1e-9) << "the new one comes along";
  EXPECT_EQ(after.master, named_sensor(3));
}

TEST(World, OneCommonSensorIsEnough) {
  const Registration after =
      in_world_of(anchors_of(world_ring({2})), world_ring({1, 2}, kElsewhere));
  EXPECT_LT(apart(world_ring({1}), after, 1), 1e-9);
}

TEST(World, ASensorThatWasMovedDoesNotPullTheOthers) {
  Registration before = world_ring({1, 2, 3, 4});
  auto& carried = before.sensors.at(named_sensor(1)).world_from_sensor;
  carried = along_the_floor(0.8, 0.0, 0.3) * carried;
  const Registration after = in_world_of(anchors_of(before), world_ring({1, 2, 3, 4}, kElsewhere));
  for (const int i : {2, 3, 4}) EXPECT_LT(apart(before, after, i), 1e-9) << i;
  EXPECT_GT(apart(before, after, 1), 0.4) << "it stands elsewhere now";
}

TEST(World, OfTwoTheMasterDecidesWhichWasMoved) {
  Registration before = world_ring({1, 2});
  auto& carried = before.sensors.at(named_sensor(1)).world_from_sensor;
  carried = along_the_floor(0.8, 0.0, 0.0) * carried;
  EXPECT_LT(apart(before, in_world_of(anchors_of(before), world_ring({2, 1}, kElsewhere)), 2),
            1e-9);
  EXPECT_LT(apart(before, in_world_of(anchors_of(before), world_ring({1, 2}, kElsewhere)), 1),
            1e-9);
}

TEST(World, SmallErrorsAreSharedByAll) {
  Registration before = world_ring({1, 2, 3, 4, 5});
  for (int i = 1; i <= kRing; ++i)
    before.sensors.at(named_sensor(i)).world_from_sensor.translation().x() +=
        i % 2 == 0 ? 0.01 : -0.01;
  const Registration after =
      in_world_of(anchors_of(before), world_ring({1, 2, 3, 4, 5}, kElsewhere));
  for (int i = 1; i <= kRing; ++i) EXPECT_LT(apart(before, after, i), 0.02) << i;
}

TEST(World, ASensorThatWasPushedByCentimetresHardlyPulls) {
  const Registration before = world_ring({1, 2, 3, 4, 5});
  Registration walk = world_ring({1, 2, 3, 4, 5}, kElsewhere);
  auto& pushed = walk.sensors.at(named_sensor(2)).world_from_sensor;
  pushed = along_the_floor(0.1, 0.1, 0.0) * pushed;
  const Registration after = in_world_of(anchors_of(before), walk);
  for (const int i : {1, 3, 4, 5}) EXPECT_LT(apart(before, after, i), 0.003) << i;
  EXPECT_FALSE(after.anchors.contains(named_sensor(2))) << "it is anchored where it stands now";
  EXPECT_TRUE(after.anchors.contains(named_sensor(3)));
}

/// The ring as a walk finds it whose errors move every sensor by up to 20 mm.
Registration walked_ring(int seed) {
  Registration r = world_ring({1, 2, 3, 4, 5}, kElsewhere);
  for (int i = 1; i <= kRing; ++i) {
    const double angle = 2.4 * seed * i + 0.7 * seed;
    r.sensors.at(named_sensor(i)).world_from_sensor.translation() +=
        0.02 * Eigen::Vector3d(std::sin(angle), 0.0, std::cos(1.3 * angle));
  }
  return r;
}

TEST(World, ManyRegistrationsGoNoFartherThanOne) {
  const Registration first = world_ring({1, 2, 3, 4, 5});
  Registration now = first;
  for (int seed = 1; seed <= 50; ++seed) {
    const Registration alone = in_world_of(anchors_of(first), walked_ring(seed));
    now = in_world_of(anchors_of(now), walked_ring(seed));
    for (int i = 1; i <= kRing; ++i) EXPECT_LT(apart(alone, now, i), 1e-9) << seed;
  }
}

TEST(World, WhoIsAwayForAWhileKeepsTheAnchor) {
  const Registration first = world_ring({1, 2, 3});
  Registration now = in_world_of(anchors_of(first), world_ring({1, 2}, kElsewhere));
  EXPECT_TRUE(now.anchors.contains(named_sensor(3)));
  now = in_world_of(anchors_of(now), world_ring({3, 4}, kElsewhere));
  EXPECT_LT(apart(first, now, 3), 1e-9);
}

TEST(World, FloorsStayWhatTheNewWalkSays) {
  Eigen::Isometry3d higher = kElsewhere;
  higher.translation().y() = 0.05;
  const Registration before = world_ring({1, 2, 3});
  const Registration after = in_world_of(anchors_of(before), world_ring({1, 2, 3}, higher));
  EXPECT_NEAR(apart(before, after, 2), 0.05, 1e-9);
}

TEST(World, WithoutACommonSensorItIsTheMasters) {
  const Registration alone = world_ring({4, 5}, kElsewhere);
  EXPECT_LT(apart(alone, in_world_of(anchors_of(world_ring({1, 2})), alone), 4), 1e-12);
  EXPECT_LT(apart(alone, in_world_of({}, alone), 4), 1e-12);
}

TEST(Moved, TurnsTheCovarianceAlong) {
  Extrinsics place;
  place.covariance.diagonal() << 1, 2, 3, 4, 5, 6;
  const Extrinsics turned = moved(place, along_the_floor(1, 1, deg(90)));
  Eigen::Matrix<double, 6, 1> expected;
  expected << 3, 2, 1, 6, 5, 4;
  EXPECT_LT((turned.covariance.diagonal() - expected).norm(), 1e-12);
}

TEST(Origin, WhatStoodThereIsAtTheBeginningAndItsFrontIsTheFront) {
  const Registration before = world_ring({1, 2, 3});
  const auto after = with_origin(before, {1.5, -2.0, deg(90)});
  ASSERT_TRUE(after);
  const Eigen::Isometry3d new_from_old =
      after->sensors.at(named_sensor(1)).world_from_sensor *
      before.sensors.at(named_sensor(1)).world_from_sensor.inverse();
  EXPECT_LT((new_from_old * Eigen::Vector3d(1.5, 0.3, -2.0) - Eigen::Vector3d(0, 0.3, 0)).norm(),
            1e-9);
  // Yaw 90 degrees turns +z to +x, so moving 1 m along the old +x gives new z = 1.
  EXPECT_LT((new_from_old * Eigen::Vector3d(2.5, 0.0, -2.0) - Eigen::Vector3d(0, 0, 1)).norm(),
            1e-9);
  EXPECT_LT(apart(*with_origin(*after, {}), *after, 2), 1e-12);
}

TEST(Origin, AnchorsTheSensorsWhereTheyStand) {
  Registration before = world_ring({1, 2, 3});
  before.anchors[named_sensor(1)] = Eigen::Isometry3d::Identity();
  const auto after = with_origin(before, {1.5, -2.0, deg(90)});
  ASSERT_TRUE(after);
  EXPECT_TRUE(anchors_of(*after)
                  .at(named_sensor(1))
                  .isApprox(after->sensors.at(named_sensor(1)).world_from_sensor));
}

TEST(Origin, NeedsAPlaceAndSaneNumbers) {
  EXPECT_EQ(with_origin({}, {}).error().code, ErrorCode::NotFound);
  const double nan = std::nan("");
  for (const Origin& wrong : {Origin{nan, 0, 0}, Origin{0, 1001, 0}, Origin{0, 0, nan},
                              Origin{-2000, 0, 0}, Origin{0, 0, INFINITY}})
    EXPECT_EQ(with_origin(world_ring({1, 2}), wrong).error().code, ErrorCode::InvalidArgument);
}

TEST(World, ThatMovedAsAWholeIsToldFromOneThatDidNot) {
  const Registration before = world_ring({1, 2, 3});
  const auto moved = moved_world(before, world_ring({1, 2, 4}, kElsewhere));
  ASSERT_TRUE(moved);
  EXPECT_TRUE(moved->isApprox(kElsewhere, 1e-9));
  EXPECT_FALSE(moved_world(before, before)) << "nothing moved";
  EXPECT_FALSE(moved_world(before, world_ring({4}, kElsewhere))) << "nothing in common";
  Registration pushed = world_ring({1, 2, 3}, kElsewhere);
  pushed.sensors[named_sensor(2)].world_from_sensor.translation().x() += 0.01;
  EXPECT_FALSE(moved_world(before, pushed));
  Eigen::Isometry3d tilted = kElsewhere;
  tilted.rotate(Eigen::AngleAxisd(deg(1.0), Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(moved_world(before, world_ring({1, 2, 3}, tilted)));
}

}  // namespace
}  // namespace chorus::core
