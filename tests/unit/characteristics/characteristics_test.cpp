#include "common/characteristics/characteristics.h"

#include <gmock/gmock.h>

#include <map>
#include <numbers>

#include "tests/support/matchers.h"
#include "tests/unit/characteristics/turning_person.h"

namespace chorus::characteristics {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using ::testing::Contains;
using ::testing::HasSubstr;

std::string refusal_of(const std::vector<SensorFrame>& frames) {
  const auto found = characterise(frames);
  return found ? "nothing refused" : to_string(found.error());
}

Characteristics found_of(const TurnSpec& spec) {
  auto found = characterise(record_turn(spec));
  EXPECT_THAT(found, IsOk());
  return found.value_or(Characteristics{});
}

TEST(Jitter, IsTheStandardDeviationOfWhiteNoiseThoughThePersonTurns) {
  TurnSpec spec;
  spec.along = mm(9);
  spec.across = mm(4);
  const Jitter jitter = found_of(spec).jitter;
  for (const JointId id : {JointId::Neck, JointId::ShoulderLeft, JointId::HandTipRight}) {
    const JitterCell cell = jitter_over(jitter, {id}, JointState::Tracked);
    EXPECT_NEAR(to_mm(cell.along), 9.0, 0.7) << name_of(id);
    EXPECT_NEAR(to_mm(cell.across), 4.0, 0.3) << name_of(id);
    EXPECT_GT(cell.frames, 350u);
  }
}

TEST(Jitter, TurningAloneIsNone) {
  const Jitter jitter = found_of({}).jitter;
  ASSERT_FALSE(jitter.cells.empty());
  for (const JitterCell& cell : jitter.cells)
    EXPECT_LT(std::hypot(cell.along, cell.across), mm(0.5)) << name_of(cell.joint);
  ASSERT_FALSE(jitter.steps.empty());
  for (const StepCell& cell : jitter.steps) EXPECT_LT(cell.step, mm(0.5)) << name_of(cell.joint);
}

TEST(Jitter, StepsAreTheMeanDistancesFromFrameToFrameOnEachSide) {
  TurnSpec spec;
  spec.along = spec.across = mm(4);
  std::map<Side, StepCell> neck;
  for (const StepCell& cell : found_of(spec).jitter.steps) {
    if (cell.joint == JointId::Neck) neck[cell.side] = cell;
  }
  ASSERT_EQ(neck.size(), 3u);
  // The mean length of the difference of two points with independent normal errors, in 3-D.
  const double expected = 4 * std::sqrt(2.0) * std::sqrt(8 / std::numbers::pi);
  for (const auto& [side, cell] : neck) EXPECT_NEAR(to_mm(cell.step), expected, 0.7);
  // 8 of 30 s of standing, and of each turn 70, 220 and 70 of 360 deg.
  EXPECT_GT(neck[Side::Front].frames, neck[Side::Rear].frames);
  EXPECT_GT(neck[Side::Side].frames, neck[Side::Rear].frames);
}

TEST(Jitter, OfGuessedJointsIsCountedByItself) {
  TurnSpec spec;
  spec.along = spec.across = mm(2);
  auto frames = record_turn(spec);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (SensorFrame& frame : frames) {
    Joint& wrist = frame.bodies[0].skeleton[JointId::WristLeft];
    wrist.state = JointState::Inferred;
    wrist.position.y() += mm(20) * normal(random);
  }
  const auto found = characterise(frames);
  ASSERT_THAT(found, IsOk());
  EXPECT_EQ(jitter_over(found->jitter, {JointId::WristLeft}, JointState::Tracked).frames, 0u);
  EXPECT_GT(noise_of(found->jitter).inferred_factor, 4.0);
  EXPECT_NEAR(found->coverage.joints[index_of(JointId::WristLeft)].inferred, 1.0, 1e-6);
  EXPECT_EQ(found->coverage.joints[index_of(JointId::WristRight)].inferred, 0.0);
}

TEST(Exchange, IsFoundAtItsAnglesOutAndBack) {
  TurnSpec spec;
  spec.along = spec.across = mm(3);
  spec.out = deg(130);
  spec.back = deg(60);
  const Exchange exchange = found_of(spec).exchange;
  EXPECT_EQ(exchange.front_rear, FrontRear::TakesForFacing);
  ASSERT_EQ(exchange.out.size(), 2u);  // once on the way there, once on the way back
  ASSERT_EQ(exchange.back.size(), 2u);
  for (const double angle : exchange.out) EXPECT_NEAR(to_deg(angle), 130, 4);
  for (const double angle : exchange.back) EXPECT_NEAR(to_deg(angle), 60, 4);
  EXPECT_NEAR(to_deg(exchange.turned), 720, 30);
  EXPECT_GT(exchange.sectors[6].exchanged_back_s, 0.9 * exchange.sectors[6].back_s);
  EXPECT_EQ(exchange.sectors[6].exchanged_away_s, 0.0);
}

TEST(Exchange, ASensorThatIsRightFromBehindTells) {
  const Exchange exchange = found_of({}).exchange;
  EXPECT_EQ(exchange.front_rear, FrontRear::Tells);
  EXPECT_TRUE(exchange.out.empty());
}

TEST(Exchange, NothingIsSaidWhileNobodyTurnsTheirBack) {
  TurnSpec spec;
  spec.turn = deg(100);
  EXPECT_EQ(found_of(spec).exchange.front_rear, FrontRear::Unknown);
}

/// A tracker that never shows more than 60 deg and slides back to the other side of the front.
void show_facing(std::vector<SensorFrame>& frames, const TurnSpec& spec) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double angle = turned(spec, static_cast<double>(i) / 15.0);
    const double heading = deg(180) + deg(60) * std::sin(2 * angle);
    frames[i].bodies[0].skeleton =
        testing::body_seen_from(kEye, testing::standing_person({0, 0, kMarkAt}, heading), {})
            .skeleton;
  }
}

TEST(Exchange, AKnownTurnIsBelievedWhereShouldersNeverShowTheRear) {
  const TurnSpec spec;
  auto frames = record_turn(spec);
  show_facing(frames, spec);
  const auto blind = characterise(frames);
  ASSERT_THAT(blind, IsOk());
  EXPECT_NE(blind->exchange.front_rear, FrontRear::TakesForFacing);
  const auto told = characterise(frames, {.mark = {}, .turns = {{4, 15}, {19, 30}}});
  ASSERT_THAT(told, IsOk());
  EXPECT_EQ(told->exchange.front_rear, FrontRear::TakesForFacing);
}

TEST(Exchange, WhoSeemsToEndWithTheirBackToTheSensorIsUnclear) {
  TurnSpec spec;
  spec.turn = deg(180);
  spec.seconds = 18;
  auto frames = record_turn(spec);
  frames.erase(frames.begin() + 140, frames.end());
  const auto found = characterise(frames);
  ASSERT_THAT(found, IsOk());
  EXPECT_EQ(found->exchange.front_rear, FrontRear::Unclear);
}

TEST(Exchange, AWalkIsNoTurn) {
  TurnSpec spec;
  spec.walks = 0.9;
  EXPECT_EQ(found_of(spec).exchange.front_rear, FrontRear::Unclear);
}

TEST(Exchange, AMirroredPictureIsNamed) {
  auto frames = record_turn({});
  for (SensorFrame& frame : frames) exchange(frame.bodies[0].skeleton);
  const auto found = characterise(frames);
  ASSERT_THAT(found, IsOk());
  EXPECT_EQ(found->exchange.front_rear, FrontRear::Mirrored);
}

TEST(Exchange, AShortSlipIsNone) {
  auto frames = record_turn({});
  for (std::size_t i = 300; i < 303; ++i) exchange(frames[i].bodies[0].skeleton);
  const auto found = characterise(frames);
  ASSERT_THAT(found, IsOk());
  EXPECT_TRUE(found->exchange.out.empty());
}

TEST(DepthBias, IsFoundThoughThePersonStandsOffTheMark) {
  TurnSpec spec;
  spec.bias = mm(24);
  spec.off_mark = {0.03, 0, -0.06};
  const auto found = characterise(record_turn(spec), {Mark{kMarkAt, mm(5)}});
  ASSERT_THAT(found, IsOk());
  ASSERT_TRUE(found->depth_bias);
  EXPECT_NEAR(to_mm(found->depth_bias->mean.bias), 24, 2);
  EXPECT_LT(found->depth_bias->mean.sigma, mm(10));
  EXPECT_GE(found->depth_bias->mean.sigma, mm(5));
}

TEST(DepthBias, TakesAFloorAndATurn) {
  auto frames = record_turn({});
  for (SensorFrame& frame : frames) frame.floor.reset();
  const auto floorless = characterise(frames, {Mark{kMarkAt}});
  ASSERT_FALSE(floorless);
  EXPECT_THAT(to_string(floorless.error()), HasSubstr("no floor plane"));
  TurnSpec spec;
  spec.turn = deg(100);
  const auto facing = characterise(record_turn(spec), {Mark{kMarkAt}});
  ASSERT_FALSE(facing);
  EXPECT_THAT(to_string(facing.error()), HasSubstr("turn once"));
}

TEST(Coverage, CountsFramesThatAreMissing) {
  auto frames = record_turn({});
  for (std::size_t i = 10; i < frames.size(); i += 10) frames.erase(frames.begin() + long(i));
  const auto found = characterise(frames);
  ASSERT_THAT(found, IsOk());
  EXPECT_NEAR(found->coverage.delivery.lost_share, 1.0 / 11.0, 0.005);
  EXPECT_NEAR(found->coverage.delivery.step, 1 / 15.0, 1e-4);
  EXPECT_LT(found->coverage.delivery.step_sigma, 1e-6);
  EXPECT_NEAR(found->coverage.view.distance.least, 2.5, 0.2);
  EXPECT_LT(found->coverage.view.aside.most, deg(15));
  EXPECT_GT(found->coverage.view.upwards.most,
            deg(5));  // the head, seen from 1.6 m and 10 deg down
}

TEST(Refusal, SaysWhatToRecordInstead) {
  EXPECT_THAT(refusal_of({}), HasSubstr("saw nobody"));
  TurnSpec brief;
  brief.seconds = 4;
  brief.turn = 0;
  EXPECT_THAT(refusal_of(record_turn(brief)), HasSubstr("record at least 5 s"));
  TurnSpec walking;
  walking.walks = 2.0;
  EXPECT_THAT(refusal_of(record_turn(walking)), HasSubstr("stays on one spot"));
  auto two = record_turn({});
  for (SensorFrame& frame : two) frame.bodies.push_back(frame.bodies.front());
  EXPECT_THAT(refusal_of(two), HasSubstr("several people"));
  auto rays = record_turn({});
  for (SensorFrame& frame : rays) {
    for (Joint& joint : frame.bodies[0].skeleton.joints) {
      joint.position.normalize();
      joint.measurement = Measurement::Ray;
    }
  }
  EXPECT_THAT(refusal_of(rays), HasSubstr("rays"));
}

}  // namespace
}  // namespace chorus::characteristics
