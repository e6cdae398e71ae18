// A suit on a walking person: calibrates itself, agrees, and tells a slip; the simulator's word.
#include "services/evaluation/live_judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/unit/evaluation_service/walked_suit.h"

namespace chorus::evaluation_service {
namespace {

using inertial::Limb;
using ::testing::HasSubstr;
using testing::on;
using testing::walk;
using testing::WalkedSuit;

const SensorId kSuit = testing::sensor_id("suit");

TEST(ASuitOnAWalkingPerson, CalibratesItselfAgreesAndTellsASlip) {
  WalkedSuit suit;
  suit.slip = [](double t) { return t < 14.0 ? 0.0 : deg(70); };
  LiveJudge judge;
  walk(judge, suit, 0.0, 2.0);
  EXPECT_EQ(on(judge, Limb::ForearmLeft).state, LimbState::Calibrating);
  EXPECT_THAT(words_for(on(judge, Limb::ForearmLeft)),
              HasSubstr("bend and stretch the left elbow"));
  walk(judge, suit, 2.0, 13.9);
  for (const LimbJudgement& limb : judge.limbs()) {
    EXPECT_EQ(limb.state, LimbState::Good) << words_for(limb);
    EXPECT_EQ(limb.person, PersonId{7});
    EXPECT_LT(limb.error ? to_deg(limb.error->angle) : 180.0, 5.0);
  }
  ASSERT_EQ(judge.limbs().size(), 3u);
  EXPECT_TRUE(judge.segments().empty());
  walk(judge, suit, 13.9, 18.0);
  EXPECT_EQ(words_for(on(judge, Limb::ForearmLeft)), "left forearm off by 70 deg for 4 s");
  EXPECT_EQ(on(judge, Limb::Chest).state, LimbState::Good);
  ASSERT_EQ(judge.segments().size(), 1u);
  EXPECT_EQ(judge.segments()[0].limb, Limb::ForearmLeft);
  EXPECT_NEAR(seconds(judge.segments()[0].segment.began - testing::kStart), 14.0, 0.1);
}

TEST(ASuitOnAWalkingPerson, CanBeCalibratedByWhatAnotherTakeFound) {
  const WalkedSuit suit;
  LiveJudge first;
  EXPECT_FALSE(first.calibration(kSuit));
  walk(first, suit, 0.0, 12.0);
  const auto found = first.calibration(kSuit);
  ASSERT_TRUE(found) << to_string(found.error());
  ASSERT_EQ(found->sensors.size(), 3u);
  JudgeOptions options;
  options.calibrations = {*found};
  LiveJudge second(options);
  walk(second, suit, 20.0, 20.2);
  for (const LimbJudgement& limb : second.limbs()) {
    EXPECT_EQ(limb.state, LimbState::Good) << words_for(limb);
  }
  ASSERT_TRUE(second.forget_calibration(kSuit));
  walk(second, suit, 20.2, 20.4);
  EXPECT_EQ(on(second, Limb::Chest).state, LimbState::Calibrating);
  EXPECT_FALSE(second.forget_calibration(testing::sensor_id("other")));
}

TEST(ASuitOnAWalkingPerson, SensorsWithoutSayingNamesNeedTheirLimbs) {
  WalkedSuit suit;
  suit.prefix = "00B4";
  LiveJudge unknown;
  walk(unknown, suit, 0.0, 0.2);
  ASSERT_EQ(unknown.limbs().size(), 3u);
  for (const LimbJudgement& limb : unknown.limbs()) {
    EXPECT_FALSE(limb.limb);
    EXPECT_EQ(limb.state, LimbState::Waiting);
  }
  JudgeOptions options;
  options.limbs[kSuit][suit.name(Limb::Chest)] = Limb::Chest;
  LiveJudge named(options);
  walk(named, suit, 0.0, 0.2);
  EXPECT_EQ(on(named, Limb::Chest).state, LimbState::Calibrating);
}

/// Two people in sight from the beginning, of whom the first wears the suit.
class TwoPeople : public ::testing::Test {
 protected:
  LimbJudgement see(double t) {
    TrackedInstant instant = suit.tracked(t);
    instant.people.emplace_back(PersonId{8}, synthetic::truth(suit.scene, 1, instant.captured));
    judge.take(suit.instant(t - 0.01));
    judge.take(suit.instant(t + 0.01));
    judge.take(instant);
    (void)judge.judge();
    return on(judge, Limb::Chest);
  }
  WalkedSuit suit;
  LiveJudge judge;
};

TEST_F(TwoPeople, TheOneWhoWasAloneInSightWearsIt) {
  EXPECT_EQ(see(0.1).state, LimbState::Waiting);
  EXPECT_THAT(see(0.2).reason, HasSubstr("who of those in sight wears the suit"));
  walk(judge, suit, 0.3, 0.5);
  EXPECT_EQ(see(0.6).person, PersonId{7});
  EXPECT_EQ(see(0.7).state, LimbState::Calibrating);
}

TEST_F(TwoPeople, TheOneWhomItFitsWearsIt) {
  double t = 0.1;
  for (; t < 10.0 && see(t).state == LimbState::Waiting;) t += 0.1;
  EXPECT_EQ(on(judge, Limb::Chest).person, PersonId{7}) << on(judge, Limb::Chest).reason;
  EXPECT_LT(t, 6.5);
}

TEST(LiveJudge, SaysWhichSideIsSilentAndWaitsForNeitherForever) {
  const WalkedSuit suit;
  LiveJudge judge;
  walk(judge, suit, 0.0, 0.5);
  judge.take(TrackedInstant{testing::kStart + from_seconds(1.2), {}});
  EXPECT_FALSE(judge.judge()) << "the sensors may still come";
  judge.take(suit.tracked(1.3));
  judge.take(suit.tracked(2.4));
  EXPECT_EQ(judge.judge(), testing::kStart + from_seconds(1.3));
  EXPECT_EQ(on(judge, Limb::Chest).reason, "the sensor is silent");
  judge.take(suit.instant(2.35));
  judge.take(suit.instant(2.45));
  judge.take(TrackedInstant{testing::kStart + from_seconds(2.42), {}});
  EXPECT_EQ(judge.judge(), testing::kStart + from_seconds(2.42));
  EXPECT_EQ(on(judge, Limb::Chest).reason, "the tracker sees nobody");
  LiveJudge nothing;
  EXPECT_FALSE(nothing.judge());
  nothing.take(suit.tracked(0.0));
  EXPECT_TRUE(nothing.judge());
  EXPECT_TRUE(nothing.limbs().empty());
}

}  // namespace
}  // namespace chorus::evaluation_service
