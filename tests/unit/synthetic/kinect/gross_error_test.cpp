#include "common/synthetic/kinect/gross_error.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/builders.h"

namespace chorus::synthetic::kinect {
namespace {

using enum JointId;

Skeleton<SensorSpace> turned_person(double facing) {
  const Eigen::Isometry3d world_from_sensor = testing::sensor_pose({0, 1, 0}, 0.0);
  return to_sensor(world_from_sensor.inverse(),
                   testing::standing_person({0, 0, 2.5}, deg(180) + facing));
}

GrossError with_merge(double share) {
  GrossError gross = nominal_profile("A").gross;
  gross.leg_merge = share;
  return gross;
}

GrossError with_swap(double probability) {
  GrossError gross = nominal_profile("A").gross;
  gross.id_swap = probability;
  return gross;
}

TEST(MergeLegs, PullsTheFarLegTowardsTheNearOneWhereTheyCross) {
  const auto exact = turned_person(deg(90));
  auto body = exact;
  merge_legs(body, with_merge(0.3));
  const bool left_far = exact[KneeLeft].position.z() > exact[KneeRight].position.z();
  const JointId far = left_far ? KneeLeft : KneeRight;
  const JointId near = left_far ? KneeRight : KneeLeft;
  EXPECT_EQ(body[near].position, exact[near].position);
  EXPECT_NEAR((body[far].position - body[near].position).norm(),
              0.7 * (exact[far].position - exact[near].position).norm(), 1e-9);
  EXPECT_EQ(body[far].state, JointState::Inferred);
}

TEST(MergeLegs, LeavesLegsThatAreSeenApartAndDoesNothingForNothing) {
  auto front = turned_person(0);
  merge_legs(front, with_merge(0.3));
  EXPECT_EQ(front[KneeLeft].position, turned_person(0)[KneeLeft].position);
  EXPECT_EQ(front[KneeLeft].state, JointState::Tracked);
  auto side = turned_person(deg(90));
  merge_legs(side, with_merge(0.0));
  EXPECT_EQ(side[KneeLeft].state, JointState::Tracked);
  EXPECT_EQ(side[KneeRight].state, JointState::Tracked);
}

TEST(Ghost, ComesAboutAsOftenAsStatedAndStandsStill) {
  GrossError gross = nominal_profile("A").gross;
  gross.ghosts_per_minute = 6;
  gross.ghost_time = 1.0;
  int shown = 0;
  std::set<double> places;
  constexpr int kSeconds = 3000;
  for (int second = 0; second < kSeconds; ++second) {
    const auto body = ghost(gross, second + 0.5, {});
    if (!body) continue;
    ++shown;
    places.insert(body->skeleton[SpineBase].position.z());
    for (const Joint& joint : body->skeleton.joints) EXPECT_TRUE(joint.position.allFinite());
  }
  EXPECT_NEAR(shown / static_cast<double>(kSeconds), 0.1, 0.02);
  EXPECT_EQ(places.size(), 1u) << "the same piece of furniture";
}

TEST(Ghost, StandsWhereAndIsAsLargeAsStated) {
  GrossError gross = nominal_profile("A").gross;
  gross.ghosts_per_minute = 60;
  gross.ghost_time = 1.0;
  gross.ghost_aside = 0.5;
  gross.ghost_near = 3.0;
  gross.ghost_far = 3.2;
  gross.ghost_below = 0.4;
  gross.ghost_joint = 0.1;
  for (std::uint64_t sensor = 0; sensor < 50; ++sensor) {
    const auto body = ghost(gross, 0.5, {1, sensor, 0});
    ASSERT_TRUE(body.has_value());
    const Eigen::Vector3d& seat = body->skeleton[SpineBase].position;
    EXPECT_LE(std::abs(seat.x()), 0.5);
    EXPECT_EQ(seat.y(), -0.4);
    EXPECT_GE(seat.z(), 3.0);
    EXPECT_LE(seat.z(), 3.2);
    EXPECT_NEAR((body->skeleton[Head].position - seat).y(), 0.4, 1e-9);
  }
}

TEST(Ghost, NoneWhenSwitchedOff) {
  GrossError gross = nominal_profile("A").gross;
  gross.ghosts_per_minute = 0;
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(ghost(gross, i, {}).has_value());
  gross = {};
  gross.ghosts_per_minute = 10;
  EXPECT_FALSE(ghost(gross, 1.0, {}).has_value()) << "a ghost that lasts no time";
}

/// Two people touch and part `contacts` times; returns how often their ids were exchanged.
int swaps(double probability, int contacts) {
  IdBook book({1, 0, 0}, 2);
  const GrossError gross = with_swap(probability);
  int count = 0;
  for (int i = 0; i < contacts; ++i) {
    const BodyId before = book.id_of(0);
    book.look({{0, 0, 2}, {0.3, 0, 2}}, gross, i);
    book.look({{0, 0, 2}, {0.31, 0, 2}}, gross, i + 0.3);
    count += book.id_of(0) != before;
    book.look({{0, 0, 2}, {2, 0, 2}}, gross, i + 0.6);
  }
  return count;
}

TEST(IdBook, SwapsAtTheStatedRatePerContact) {
  EXPECT_EQ(swaps(0.0, 200), 0);
  EXPECT_EQ(swaps(1.0, 200), 200) << "once per contact, not per frame";
  EXPECT_NEAR(swaps(0.3, 2000) / 2000.0, 0.3, 0.04);
}

TEST(IdBook, KeepsIdsApartAndIgnoresTheUnseen) {
  IdBook book({1, 0, 0}, 6);
  std::set<std::uint64_t> ids;
  for (std::size_t i = 0; i < 6; ++i) ids.insert(book.id_of(i).value);
  EXPECT_EQ(ids.size(), 6u);
  const BodyId before = book.id_of(0);
  const Eigen::Vector3d unseen = Eigen::Vector3d::Constant(std::nan(""));
  book.look(std::vector<Eigen::Vector3d>(6, unseen), with_swap(1.0), 1.0);
  EXPECT_EQ(book.id_of(0), before);
}

}  // namespace
}  // namespace chorus::synthetic::kinect
