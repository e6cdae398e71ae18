// A new solve never degrades a good registration, and a new sensor moves none of the others.
#include "fusion-server/core/adoption.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::core {
namespace {

SensorId named(const char* text) { return *SensorId::parse(text); }

constexpr int kAdoptionRing = 5;

/// Sensors s1, s2, ... of the ring, in a world moved by `world_from_ring`.
Registration adopted_ring(
    Verdict verdict, std::vector<int> members,
    const Eigen::Isometry3d& world_from_ring = Eigen::Isometry3d::Identity()) {
  Registration r;
  r.verdict = verdict;
  for (const int i : members) {
    const SensorId sensor = named(("s" + std::to_string(i)).c_str());
    if (r.sensors.empty()) r.master = sensor;
    r.sensors[sensor].world_from_sensor =
        world_from_ring * testing::ring_sensor(i - 1, kAdoptionRing);
    r.sensors[sensor].chain = {r.master, sensor};
    r.verdicts[sensor] = {verdict, {}};
  }
  return r;
}

Eigen::Isometry3d elsewhere() {
  Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
  move.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
  move.translation() = Eigen::Vector3d(1.0, 0.02, -2.0);
  return move;
}

TEST(Replacing, AFailingSolveNeverReplacesAnything) {
  const Registration good = adopted_ring(Verdict::Good, {1, 2});
  for (const Verdict verdict : {Verdict::None, Verdict::Refused}) {
    EXPECT_FALSE(adopted(good, adopted_ring(verdict, {1, 2, 3}), SolveKind::Final, false));
    EXPECT_FALSE(adopted({}, adopted_ring(verdict, {1}), SolveKind::Final, false));
  }
  EXPECT_FALSE(adopted({}, adopted_ring(Verdict::Good, {}), SolveKind::Final, false));
}

TEST(Replacing, AnythingUsableReplacesNothing) {
  EXPECT_TRUE(
      should_replace({}, adopted_ring(Verdict::Provisional, {1, 2}), SolveKind::Provisional));
}

TEST(Replacing, NeverByASmallerCircle) {
  const Registration three = adopted_ring(Verdict::Provisional, {1, 2, 3});
  EXPECT_FALSE(should_replace(three, adopted_ring(Verdict::Good, {1, 2}), SolveKind::Final));
  EXPECT_FALSE(should_replace(three, adopted_ring(Verdict::Good, {1, 2, 4}), SolveKind::Final));
}

TEST(Replacing, AFinishedGoodWalkReplacesAnOlderGoodOneButNotHalfway) {
  const Registration good = adopted_ring(Verdict::Good, {1, 2});
  EXPECT_TRUE(should_replace(good, good, SolveKind::Final));
  EXPECT_FALSE(should_replace(good, good, SolveKind::Provisional));
  EXPECT_FALSE(should_replace(good, adopted_ring(Verdict::Provisional, {1, 2}), SolveKind::Final));
}

TEST(Replacing, ProvisionalOnesFollowEachOtherDuringAWalk) {
  const Registration provisional = adopted_ring(Verdict::Provisional, {1, 2});
  EXPECT_TRUE(should_replace(provisional, provisional, SolveKind::Provisional));
  EXPECT_TRUE(
      should_replace(provisional, adopted_ring(Verdict::Good, {1, 2}), SolveKind::Provisional));
}

/// The candidate's offsets refer to another common clock, which is 30 ms off ours.  s2, which
/// already has a place, shows this: its offset is 75 instead of 100 ms, and its least age shows
/// that its clock has drifted by 5 ms.
TEST(Extending, TakesTheNewcomersClockByOurCommonClock) {
  using std::chrono::milliseconds;
  Registration current = adopted_ring(Verdict::Good, {1, 2, 3});
  current.clocks[named("s1")] = {milliseconds(0), milliseconds(0)};
  current.clocks[named("s2")] = {milliseconds(100), milliseconds(3)};
  current.clocks[named("s2")].least_age = milliseconds(110);
  Registration candidate = adopted_ring(Verdict::Good, {1, 2, 3, 4});
  candidate.clocks[named("s2")] = {milliseconds(75), milliseconds(4)};
  candidate.clocks[named("s2")].least_age = milliseconds(115);
  candidate.clocks[named("s4")] = {milliseconds(-50), milliseconds(0)};
  const auto wider = adopted(current, candidate, SolveKind::Provisional, true);
  ASSERT_TRUE(wider) << wider.error().message;
  EXPECT_EQ(wider->clocks.at(named("s2")).added, milliseconds(100)) << "held";
  EXPECT_EQ(wider->clocks.at(named("s4")).added, milliseconds(-20));
  EXPECT_NEAR(chorus::seconds(wider->clocks.at(named("s4")).sigma), 0.005, 1e-6);

  // If the clocks of all placed sensors are known from clock exchanges, our common clock is the
  // one that they were compared with.
  current.clocks.clear();
  candidate.clocks[named("s2")] = {milliseconds(1), milliseconds(4), milliseconds(1), {}};
  const auto known = adopted(current, candidate, SolveKind::Provisional, true);
  ASSERT_TRUE(known);
  EXPECT_EQ(known->clocks.at(named("s4")).added, milliseconds(-51));
  EXPECT_FALSE(known->clocks.contains(named("s2")));
}

/// s2, which has a place, is corrected by 40 ms now and by 10 in the candidate: what the candidate
/// calls zero is 30 ms later than what we do.
TEST(Extending, TakesTheNewcomersLatencyAsTheOthersAreCorrectedNow) {
  using std::chrono::milliseconds;
  Registration current = adopted_ring(Verdict::Good, {1, 2, 3});
  current.latencies[named("s2")] = {milliseconds(40), milliseconds(2), true};
  Registration candidate = adopted_ring(Verdict::Good, {1, 2, 3, 4});
  candidate.latencies[named("s2")] = {milliseconds(10), milliseconds(2), true};
  candidate.latencies[named("s4")] = {milliseconds(20), milliseconds(3), true};
  const auto wider = adopted(current, candidate, SolveKind::Provisional, true);
  ASSERT_TRUE(wider) << wider.error().message;
  EXPECT_EQ(wider->latencies.at(named("s2")).found, milliseconds(40)) << "held";
  EXPECT_EQ(wider->latencies.at(named("s4")).found, milliseconds(50));
  EXPECT_TRUE(wider->latencies.at(named("s4")).applied);
  EXPECT_FALSE(without(*wider, named("s4"), "gone").latencies.contains(named("s4")));
}

TEST(Extending, HoldsThePlacedSensorsAndMovesTheNewOneIntoTheirWorld) {
  const Registration current = adopted_ring(Verdict::Good, {1, 2, 3});
  const Registration candidate = adopted_ring(Verdict::Good, {1, 2, 3, 4}, elsewhere());
  const auto wider = adopted(current, candidate, SolveKind::Provisional, true);
  ASSERT_TRUE(wider) << wider.error().message;
  ASSERT_EQ(wider->sensors.size(), 4u);
  for (const auto& [sensor, place] : current.sensors) {
    EXPECT_EQ(wider->sensors.at(sensor).world_from_sensor.matrix(),
              place.world_from_sensor.matrix());
  }
  EXPECT_TRUE(wider->sensors.at(named("s4"))
                  .world_from_sensor.isApprox(testing::ring_sensor(3, kAdoptionRing), 1e-9));
  EXPECT_EQ(wider->verdict, Verdict::Good);
  EXPECT_EQ(wider->master, current.master);
  EXPECT_EQ(wider->sensors.at(named("s4")).chain.front(), current.master);
}

TEST(Extending, AChainFromAForeignMasterLeadsFromTheFirstSensorThatWePlace) {
  const Registration current = adopted_ring(Verdict::Good, {1, 2, 3});
  Registration candidate = adopted_ring(Verdict::Good, {5, 1, 2, 3, 4}, elsewhere());
  candidate.sensors[named("s4")].chain = {named("s5"), named("s3"), named("s4")};
  const auto wider = adopted(current, candidate, SolveKind::Provisional, true);
  ASSERT_TRUE(wider) << wider.error().message;
  EXPECT_EQ(wider->sensors.at(named("s4")).chain,
            (std::vector{named("s1"), named("s3"), named("s4")}));
}

TEST(Extending, OneHeldSensorIsEnough) {
  const auto wider =
      adopted(adopted_ring(Verdict::Good, {2}), adopted_ring(Verdict::Good, {2, 4}, elsewhere()),
              SolveKind::Final, true);
  ASSERT_TRUE(wider) << wider.error().message;
  EXPECT_TRUE(wider->sensors.at(named("s4"))
                  .world_from_sensor.isApprox(testing::ring_sensor(3, kAdoptionRing), 1e-9));
}

TEST(Extending, ANewcomerThatIsNotGoodYetIsInUseAtOnceAndSpoilsNobodysVerdict) {
  const Registration current = adopted_ring(Verdict::Good, {1, 2});
  Registration candidate = adopted_ring(Verdict::Provisional, {1, 2, 3});
  candidate.reasons = {"the walk lasted only 8 s"};
  const auto wider = adopted(current, candidate, SolveKind::Provisional, true);
  ASSERT_TRUE(wider);
  EXPECT_EQ(verdict_of(*wider, named("s1")), Verdict::Good);
  EXPECT_EQ(verdict_of(*wider, named("s2")), Verdict::Good);
  EXPECT_EQ(verdict_of(*wider, named("s3")), Verdict::Provisional);
  EXPECT_EQ(wider->verdicts.at(named("s3")).reasons, candidate.reasons);
  EXPECT_EQ(wider->verdict, Verdict::Provisional);
}

/// The same places with these 95 % radii on the floor, in the order of the sensors after the
/// master.
Registration with_radii(Registration r, const std::vector<double>& radii) {
  auto radius = radii.begin();
  for (auto& [sensor, place] : r.sensors) {
    if (sensor == r.master || radius == radii.end()) continue;
    place.covariance.diagonal()[3] = place.covariance.diagonal()[5] =
        std::pow(*radius++ / 2.4477, 2);
  }
  return r;
}

double x_of(const Registration& r, const char* sensor) {
  return r.sensors.at(named(sensor)).world_from_sensor.translation().x();
}

TEST(Replacing, AShorterWalkMakesNoPlaceWorse) {
  const Registration longer =
      with_radii(adopted_ring(Verdict::Provisional, {1, 2, 3}), {0.014, 0.019});
  Registration shorter = with_radii(adopted_ring(Verdict::Provisional, {1, 2, 3}), {0.025, 0.034});
  EXPECT_FALSE(should_replace(longer, shorter, SolveKind::Final));
  EXPECT_FALSE(adopted(longer, shorter, SolveKind::Final, false));
  EXPECT_TRUE(should_replace(shorter, longer, SolveKind::Final)) << "a longer one does its work";
  const Registration as_good = with_radii(longer, {0.0141, 0.0185});
  EXPECT_TRUE(should_replace(longer, as_good, SolveKind::Final));
}

TEST(Replacing, ASensorThatWasMovedGetsItsNewPlaceHoweverShortTheWalk) {
  const Registration longer = with_radii(adopted_ring(Verdict::Good, {1, 2, 3}), {0.01, 0.01});
  Registration moved = with_radii(adopted_ring(Verdict::Good, {1, 2, 3}), {0.01, 0.03});
  moved.sensors.at(named("s3")).world_from_sensor.translation().x() += 0.25;
  EXPECT_TRUE(should_replace(longer, moved, SolveKind::Final));
}

TEST(Extending, TakesOnlyThePlacesThatAreBetter) {
  const Registration current =
      with_radii(adopted_ring(Verdict::Provisional, {1, 2, 3}), {0.02, 0.05});
  Registration candidate = with_radii(adopted_ring(Verdict::Provisional, {1, 2, 3}), {0.03, 0.02});
  for (const char* sensor : {"s2", "s3"})
    candidate.sensors.at(named(sensor)).world_from_sensor.translation().x() += 0.004;
  const auto next = adopted(current, candidate, SolveKind::Final, false);
  ASSERT_TRUE(next) << next.error().message;
  EXPECT_EQ(x_of(*next, "s2"), x_of(current, "s2")) << "it stood better before";
  EXPECT_GT(x_of(*next, "s3"), x_of(current, "s3") + 0.001) << "it stands better now";
}

TEST(Extending, GivenPlacesWithoutVerdictsAreHeldToo) {
  Registration given = adopted_ring(Verdict::Good, {1, 2});
  given.verdicts.clear();
  const auto wider =
      adopted(given, adopted_ring(Verdict::Good, {1, 2, 3}, elsewhere()), SolveKind::Final, true);
  ASSERT_TRUE(wider);
  EXPECT_EQ(wider->verdict, Verdict::Good);
  EXPECT_EQ(wider->verdicts.size(), 3u);
}

TEST(Extending, SaysSoWhenThePlacedSensorsDoNotStandAsTheWalkShowsThem) {
  Registration candidate = adopted_ring(Verdict::Good, {1, 2, 3});
  // Somebody has moved s2 by accident.
  candidate.sensors.at(named("s2")).world_from_sensor.translation().x() += 2.0;
  const auto wider =
      adopted(adopted_ring(Verdict::Good, {1, 2}), candidate, SolveKind::Final, true);
  ASSERT_FALSE(wider);
  EXPECT_EQ(wider.error().code, ErrorCode::Conflict);
  EXPECT_NE(wider.error().message.find("--fresh"), std::string::npos);
}

TEST(Extending, AskedForByAPersonAGoodWalkReplacesAllInTheWorldThatThereIs) {
  const Registration current = adopted_ring(Verdict::Good, {1, 2});
  Registration candidate = adopted_ring(Verdict::Good, {1, 2, 3}, elsewhere());
  candidate.sensors.at(named("s2")).error = 0.007;
  const auto next = adopted(current, candidate, SolveKind::Final, false);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->sensors.at(named("s2")).error, 0.007) << "nobody is held";
  EXPECT_EQ(next->sensors.size(), 3u);
  const Eigen::Vector3d jump = next->sensors.at(named("s1")).world_from_sensor.translation() -
                               current.sensors.at(named("s1")).world_from_sensor.translation();
  EXPECT_LT(std::hypot(jump.x(), jump.z()), 1e-9);
  EXPECT_NEAR(jump.y(), 0.02, 1e-9) << "the floor is the new walk's";
}

TEST(Refusals, AreToldOfSensorsWithoutAPlaceAndLeaveTheVerdict) {
  Registration current = adopted_ring(Verdict::Good, {1, 2});
  Registration candidate = adopted_ring(Verdict::Good, {1, 2});
  candidate.verdicts[named("s5")] = {Verdict::Refused, {"s5 saw a coat stand"}};
  candidate.verdicts[named("s1")] = {Verdict::Refused, {"not this time"}};
  note_refusals(current, candidate);
  note_refusals(current, candidate);
  EXPECT_EQ(current.verdict, Verdict::Good);
  EXPECT_EQ(current.reasons, std::vector<std::string>{"s5 saw a coat stand"});
  EXPECT_EQ(verdict_of(current, named("s1")), Verdict::Good);
  EXPECT_EQ(verdict_of(current, named("s5")), Verdict::None);
  EXPECT_EQ(current.verdicts.at(named("s5")).verdict, Verdict::Refused);
  // Once s5 is placed, the refusal noted for it earlier is gone.
  const auto wider =
      adopted(current, adopted_ring(Verdict::Good, {1, 2, 5}), SolveKind::Final, true);
  ASSERT_TRUE(wider);
  EXPECT_TRUE(wider->reasons.empty());
}

TEST(Unplaced, NamesTheSensorsThatSeeButHaveNoPlace) {
  const Registration r = adopted_ring(Verdict::Good, {1, 2});
  EXPECT_TRUE(unplaced(r, {named("s1"), named("s2")}).empty());
  EXPECT_EQ(unplaced(r, {named("s1"), named("s3")}), std::set<SensorId>{named("s3")});
  EXPECT_EQ(unplaced({}, {named("s1")}).size(), 1u);
}

}  // namespace
}  // namespace chorus::core
