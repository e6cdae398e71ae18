// Who wears the sensors, how they sit, and what they say then.
#include "fusion-server/worn/wear.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fusion-server/worn/first_pass.h"
#include "tests/unit/worn/walker.h"

namespace chorus::worn {
namespace {

using inertial::Limb;
using walker::Suit;
using walker::Walker;

/// A room whose people are seen, and a suit that the first of them wears.
struct WornWorld {
  explicit WornWorld(std::vector<Walker> all) : people(std::move(all)) {
    config.enabled = true;
    wear.configure(config, {suit.id});
  }

  /// Goes on to `end` [s] at 15 Hz; stops early if `until` holds.
  template <class Until>
  void run(double end, const Until& until) {
    constexpr double kStep = 1.0 / 15.0;
    for (; time < end; time += kStep) {
      wear.take(suit.says(people.front(), time));
      std::vector<FusedBody> bodies;
      for (const Walker& who : people) bodies.push_back(walker::fused_of(who, time, 0.015, random));
      for (FusedBody& body : bodies)
        for (const JointId id : hidden) body.contributors[index_of(id)] = 0;
      for (FusedBody& body : bodies) body.sides_confidence = sides;
      wear.learn(bodies, walker::at(time));
      pass.note(wear, bodies, walker::at(time));
      if (until()) return;
    }
  }
  void run(double end) {
    run(end, [] { return false; });
  }

  [[nodiscard]] WornReport report() const { return wear.reports(walker::at(time)).front(); }
  [[nodiscard]] bool all_calibrated() const {
    const WornReport now = report();
    return now.sensors.size() == walker::kLimbs.size() &&
           std::ranges::all_of(now.sensors, &WornSensorReport::calibrated);
  }
  /// What the sensors say of the first person, at the last instant.
  [[nodiscard]] std::vector<WornLimb> says() {
    const double last = time - 1.0 / 15.0;
    const WornPeople said = wear.say(walker::at(last));
    const auto own = said.find(PersonId{people.front().id});
    return own == said.end() ? std::vector<WornLimb>{} : own->second;
  }
  /// Largest angle by which a limb's predicted bone is off [rad].
  [[nodiscard]] double worst() {
    const double last = time - 1.0 / 15.0;
    double most = 0.0;
    for (const WornLimb& limb : says()) {
      const auto exact =
          evaluation::limb_from_joints(walker::body_of(people.front(), last), limb.limb);
      const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
      const Eigen::Vector3d a = exact->world_from_limb * y;
      const Eigen::Vector3d b = limb.world_from_limb * y;
      most = std::max(most, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
    return most;
  }

  WornConfig config;
  Suit suit;
  std::vector<Walker> people;
  std::vector<JointId> hidden;
  std::optional<double> sides = {};  ///< Of everybody.
  Wear wear;
  FirstPass pass;
  double time = 0.0;
  std::mt19937_64 random{7};
};

const Walker kWearer{.id = 1, .phase = 0.0, .tempo = 1.0};
const Walker kOther{.id = 2, .phase = 1.4, .tempo = 0.83, .x = 1.5};
const Walker kThird{.id = 3, .phase = 2.9, .tempo = 1.21, .x = -1.5};

TEST(Wear, OfThreePeopleTheOneWhoWearsItIsFoundInSeconds) {
  WornWorld world({kWearer, kOther, kThird});
  world.run(10.0, [&] { return world.report().wearer.has_value(); });
  ASSERT_TRUE(world.report().wearer);
  EXPECT_EQ(*world.report().wearer, PersonId{1});
  EXPECT_LT(world.time, 5.0);
}

TEST(Wear, WhileAllStandStillNobodyIsNamed) {
  Walker still = kWearer;
  Walker also = kOther;
  still.lively = also.lively = 0.0;
  WornWorld world({still, also});
  world.run(8.0);
  EXPECT_FALSE(world.report().wearer);
  EXPECT_NE(world.report().reason.find("still"), std::string::npos);
  EXPECT_TRUE(world.says().empty());
}

TEST(Wear, SomebodyElseAloneIsNotTakenForTheWearer) {
  WornWorld world({kWearer});
  std::vector<FusedBody> bodies;
  for (double t = 0.0; t < 10.0; t += 1.0 / 15.0) {
    world.wear.take(world.suit.says(kWearer, t));
    world.wear.learn({walker::fused_of(kOther, t, 0.015, world.random)}, walker::at(t));
  }
  EXPECT_FALSE(world.report().wearer);
}

TEST(Wear, CalibratesWhileSomebodyMovesAndThenKnowsTheLimbs) {
  WornWorld world({kWearer});
  world.run(25.0, [&] { return world.all_calibrated(); });
  ASSERT_TRUE(world.all_calibrated());
  world.run(world.time + 5.0);
  EXPECT_EQ(world.says().size(), walker::kLimbs.size());
  EXPECT_LT(world.worst(), deg(6));
}

TEST(Wear, ADriftingSuitIsFollowed) {
  WornWorld world({kWearer});
  world.suit.drift = deg(0.3);
  world.run(40.0);
  ASSERT_TRUE(world.all_calibrated());
  EXPECT_LT(world.worst(), deg(8));  // 12 degrees without
}

TEST(Wear, ASensorThatSlipsIsToldLeftOutAndCalibratedAgain) {
  WornWorld world({kWearer});
  world.run(20.0);
  ASSERT_TRUE(world.all_calibrated());
  world.suit.slip[inertial::Limb::ShankLeft] = deg(60);
  const auto shank = [&] {
    const WornReport now = world.report();
    return *std::ranges::find(now.sensors, "ShankLeft", &WornSensorReport::sensor);
  };
  world.run(30.0, [&] { return shank().slipped_ago.has_value(); });
  EXPECT_LT(world.time, 25.0);
  EXPECT_NEAR(shank().slip, deg(60), deg(20));
  EXPECT_FALSE(shank().calibrated);
  EXPECT_EQ(world.says().size(), walker::kLimbs.size() - 1);
  world.run(world.time + 12.0);
  EXPECT_TRUE(shank().calibrated);
  EXPECT_LT(world.worst(), deg(6));
}

/// The same recording again, which begins with what was found.
WornWorld again(const WornWorld& first) {
  WornWorld second(first.people);
  second.suit.drift = first.suit.drift;
  second.wear.begin_with(first.pass.found());
  return second;
}

TEST(FirstPass, WhatItFoundServesFromTheBeginning) {
  WornWorld world({kWearer, kOther});
  world.suit.drift = deg(0.3);
  world.run(30.0);
  ASSERT_TRUE(world.all_calibrated());
  WornWorld second = again(world);
  second.run(0.2);
  EXPECT_EQ(second.says().size(), walker::kLimbs.size());
  EXPECT_LT(second.worst(), deg(10)) << "headings as they were later, and have wandered since";
  second.run(8.0);
  EXPECT_EQ(second.says().size(), walker::kLimbs.size()) << "nothing is told as slipped";
  EXPECT_LT(second.worst(), deg(8));
}

TEST(FirstPass, ASlipEndsWhatIsCarriedBackAndTheSecondPassTellsIt) {
  WornWorld world({kWearer});
  world.run(20.0);
  ASSERT_TRUE(world.all_calibrated());
  world.suit.slip[inertial::Limb::ShankLeft] = deg(60);
  world.run(45.0);
  WornWorld second = again(world);
  second.run(5.0);
  EXPECT_EQ(second.says().size(), walker::kLimbs.size());
  EXPECT_LT(second.worst(), deg(8)) << "as it sat before it slipped";
  second.run(20.0);
  second.suit.slip = world.suit.slip;
  second.run(25.0, [&] { return second.says().size() < walker::kLimbs.size(); });
  EXPECT_LT(second.time, 24.9) << "told";
  second.run(37.0);
  EXPECT_EQ(second.says().size(), walker::kLimbs.size()) << "calibrated again, as live";
  EXPECT_LT(second.worst(), deg(8));
}

TEST(FirstPass, SomebodyElsewhereIsNotTheWearer) {
  WornWorld world({kWearer});
  world.run(15.0);
  auto found = world.pass.found();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().wearer, PersonId{1});
  found.front().seen.place.x() += 2.0;
  WornWorld second({kWearer});
  second.wear.begin_with(found);
  second.run(0.3);
  EXPECT_TRUE(second.says().empty());
  EXPECT_FALSE(second.report().wearer);
}

TEST(FirstPass, LooksForAsLongAsCalibrationsImprove) {
  WornWorld world({kWearer});
  EXPECT_FALSE(world.pass.enough());
  world.run(20.0);
  EXPECT_FALSE(world.pass.enough());
  world.people.front().id = 9;  // somebody else
  world.run(35.0);
  EXPECT_TRUE(world.pass.enough()) << "the first wearing is over";
  EXPECT_EQ(world.pass.found().front().wearer, PersonId{1});
}

TEST(Wear, AWearerWhoGetsAnotherIdWhereTheyStandIsFollowed) {
  WornWorld world({kWearer, kOther});
  world.run(20.0);
  ASSERT_TRUE(world.all_calibrated());
  world.people.front().id = 9;
  world.run(20.5);
  EXPECT_EQ(world.report().wearer, PersonId{9});
  EXPECT_TRUE(world.all_calibrated());
  EXPECT_EQ(world.says().size(), walker::kLimbs.size());
}

TEST(Wear, WhoComesElsewhereOrWasThereBeforeIsNotTheWearer) {
  WornWorld world({kWearer, kOther});
  world.run(20.0);
  const Suit suit = world.suit;
  for (double t = 20.0; t < 26.0; t += 1.0 / 15.0) {  // only the other one, and a newcomer
    Walker newcomer = kThird;
    newcomer.id = 7;
    world.wear.take(suit.says(kWearer, t));
    world.wear.learn({walker::fused_of(kOther, t, 0.015, world.random),
                      walker::fused_of(newcomer, t, 0.015, world.random)},
                     walker::at(t));
  }
  EXPECT_FALSE(world.wear.reports(walker::at(26.0)).front().wearer);
}

TEST(Wear, NothingIsLearnedOfLimbsWhileItIsInDoubtWhichSideIsWhich) {
  WornWorld world({kWearer});
  world.sides = 0.7;
  world.run(15.0);
  EXPECT_TRUE(world.says().empty());
  world.sides = 0.99;
  world.run(40.0, [&] { return world.all_calibrated(); });
  EXPECT_TRUE(world.all_calibrated());
}

TEST(Wear, WhatHiddenLimbsWouldShowIsNotLearned) {
  WornWorld world({kWearer});
  world.hidden = {JointId::WristLeft};
  world.run(12.0);
  const WornReport now = world.report();
  const auto forearm = std::ranges::find(now.sensors, "ForearmLeft", &WornSensorReport::sensor);
  ASSERT_NE(forearm, now.sensors.end());
  EXPECT_FALSE(forearm->calibrated);
}

TEST(Wear, ASourceThatIsNotFollowedAndOneThatIsSwitchedOffSayNothing) {
  WornWorld world({kWearer});
  world.run(5.0);
  world.wear.configure(world.config, {});
  EXPECT_TRUE(world.wear.reports(walker::at(6.0)).empty());
  WornConfig off;
  world.wear.configure(off, {world.suit.id});
  world.run(7.0);
  EXPECT_TRUE(world.wear.reports(walker::at(8.0)).empty());
}

TEST(Wear, TellsWhichSensorFallsSilentAndWhichLeavesItselfNoSay) {
  WornWorld world({{1, 0.0, 1.0, 1.0, 0.0}});
  world.run(4.0);
  ASSERT_TRUE(world.report().wearer);
  for (const WornSensorReport& one : world.report().sensors)
    EXPECT_TRUE(!one.silent_for && !one.overstated) << one.sensor;
  world.suit.states = {{Limb::ShankLeft, -1.0}, {Limb::ThighLeft, deg(200)}};
  world.run(8.0);
  for (const WornSensorReport& one : world.report().sensors) {
    EXPECT_EQ(one.silent_for.has_value(), one.limb == Limb::ShankLeft) << one.sensor;
    EXPECT_EQ(one.overstated.has_value(), one.limb == Limb::ThighLeft) << one.sensor;
    EXPECT_NEAR(one.silent_for.value_or(4.0), 4.0, 0.2);
    EXPECT_NEAR(one.overstated.value_or(deg(200)), deg(200), 1e-6);
  }
  world.config.most_sigma = deg(250);
  world.wear.configure(world.config, {world.suit.id});
  for (const WornSensorReport& one : world.report().sensors)
    EXPECT_FALSE(one.overstated) << "fusion lets it have its say: " << one.sensor;
}

/// Heading [rad] that a sensor with the heading 0.7 is found to have at 40 s: its limb is upright
/// at first, so that any heading goes with some mount; from 6 s on it leans, and is seen worse.
double heading_of_who_stood_first(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> error;
  WornSensor sensor("s", inertial::Limb::Pelvis);
  const WornConfig config;
  for (int i = 0; i < 600; ++i) {
    const double time = i / 15.0;
    const double tilt = time < 6.0 ? 0.01 : 0.1;
    const double size = time < 6.0 ? deg(2) : deg(8);
    const Eigen::Quaterniond limb =
        about_y(0.5 * std::sin(0.9 * time)) *
        exp_map({tilt * std::sin(2.1 * time), 0, tilt * std::cos(1.3 * time)});
    const Eigen::Quaterniond seen =
        limb * exp_map(size * Eigen::Vector3d(error(random), error(random), error(random)));
    const Eigen::Matrix3d stated = size * size * Eigen::Matrix3d::Identity();
    sensor.learn(time, {seen, stated, true}, about_y(-0.7) * limb * exp_map({0.3, -1.1, 0.6}),
                 config);
    if (sensor.wants_calibration(time)) sensor.calibrate(time, config);
  }
  return sensor.fit() ? sensor.heading() : 99.0;
}

TEST(WornSensor, IsCalibratedBetterOnceItsLimbMoves) {
  for (const std::uint64_t seed : {1, 2, 3})
    EXPECT_NEAR(heading_of_who_stood_first(seed), 0.7, deg(15)) << seed;
}

}  // namespace
}  // namespace chorus::worn
