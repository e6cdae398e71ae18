#include "fusion-server/site/teller.h"

#include <gtest/gtest.h>

#include "fusion-server/site/site.h"
#include "tests/judge/hall.h"

namespace chorus::site {
namespace {

constexpr Timestamp kFirst = from_unix_ns(1'795'000'000'000'000'000);
constexpr std::array<double, associate::kSpans> kAsUsual{1, 1, 1, 1, 1, 1, 1};

Snapshot snapshot(int frame, std::vector<std::uint64_t> ids) {
  Snapshot all;
  all.sequence = static_cast<std::uint64_t>(frame);
  all.instant = kFirst + frame * std::chrono::milliseconds(33);
  for (const std::uint64_t id : ids) {
    FusedBody body;
    body.id = PersonId{id};
    body.skeleton = bench::standing_body({static_cast<double>(id), 2.0}, 0.0, kAsUsual);
    body.variance.fill(4e-4);
    body.contributors.fill(0b111);
    body.sides_confidence = 0.9;
    all.bodies.push_back(body);
  }
  return all;
}

TEST(Telling, SaysSinceWhenEachPersonIsThereAndHowLongTheirLimbsAre) {
  Teller teller(*SensorId::parse("a"), 7);
  CellPeople told;
  for (int frame = 0; frame < 60; ++frame)
    told = teller.tell(snapshot(
        frame, frame < 30 ? std::vector<std::uint64_t>{1} : std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(told.boot, 7U);
  EXPECT_EQ(told.sequence, 59U);
  ASSERT_EQ(told.people.size(), 2U);
  EXPECT_EQ(told.people[0].since, kFirst);
  EXPECT_EQ(told.people[1].since, kFirst + 30 * std::chrono::milliseconds(33));
  EXPECT_NEAR(told.people[0].place.x(), 1.0, 1e-9);
  EXPECT_NEAR(told.people[0].covariance(0, 0), 4e-4, 1e-9);
  EXPECT_EQ(told.people[0].sides, 0.9);
  EXPECT_TRUE(told.people[0].joints[index_of(JointId::Head)]);
  EXPECT_NEAR(std::exp(told.people[0].lengths.mean[0]), 0.50, 1e-6);  // the trunk
  EXPECT_GT(told.people[0].lengths.variance[0], 0.0);
  // Who has been in view for longer is known better.
  EXPECT_LT(told.people[0].lengths.variance[0], told.people[1].lengths.variance[0]);
}

TEST(Telling, LeavesOutWhoHasNoPelvisAndLearnsNothingOfWhoIsOnlyExpected) {
  Teller teller(*SensorId::parse("a"), 1);
  (void)teller.tell(snapshot(0, {1}));
  Snapshot carried = snapshot(1, {1, 2});
  carried.bodies[0].carried_for = 0.2;
  carried.bodies[1].skeleton[JointId::SpineBase].state = JointState::NotTracked;
  const CellPeople told = teller.tell(carried);
  ASSERT_EQ(told.people.size(), 1U);
  EXPECT_EQ(told.people[0].carried, std::chrono::milliseconds(200));
  EXPECT_LE(told.people[0].lengths.variance[0], 0.0);
}

TEST(Telling, EntersTheNamesThatWereDecided) {
  Teller teller(*SensorId::parse("a"), 1);
  CellPeople told = teller.tell(snapshot(0, {1, 2}));
  Decision decision;
  Named named;
  named.body = PersonId{2};
  named.id = *SiteId::parse("x-1");
  named.certainty = 0.8;
  named.since = kFirst;
  decision.people.push_back(named);
  name(told, decision);
  EXPECT_FALSE(told.people[0].site_id);
  EXPECT_EQ(told.people[1].site_id, SiteId::parse("x-1").value());
  EXPECT_EQ(told.people[1].site_certainty, 0.8);
}

}  // namespace
}  // namespace chorus::site
