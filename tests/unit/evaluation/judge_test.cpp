// From tracks to scores: which sensor is where, who wears them, and where the tracker errs.
#include "common/evaluation/judge.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

constexpr double kShift = 0.11;  // tracker's time = sensors' time + this

Eigen::Quaterniond moved(double t, double phase) {
  return exp_map({0.8 * std::sin(1.1 * t + phase), 0.9 * std::sin(0.7 * t + 2 * phase),
                  0.7 * std::cos(1.7 * t - phase)});
}

TrackedBody body_of(double phase, double length = 20.0) {
  TrackedBody out;
  double own = phase;
  for (const Limb limb : {Limb::ThighLeft, Limb::ShankLeft, Limb::ThighRight}) {
    for (int i = 0; i < static_cast<int>(length * 30); ++i)
      out[limb].push_back({i / 30.0, {moved(i / 30.0, own), Eigen::Matrix3d::Zero(), true}});
    own += 1.3;
  }
  return out;
}

std::vector<JudgeSensor> sensors_of(double phase, double length = 20.0) {
  std::vector<JudgeSensor> out;
  double own = phase;
  for (const char* const name : {"a", "b", "c"}) {
    JudgeSensor sensor{name, std::nullopt, {}};
    for (int i = 0; i < static_cast<int>(length * 100); ++i)
      sensor.track.push_back(
          {i / 100.0 - kShift, about_y(own) * moved(i / 100.0, own) * exp_map({own, 1, 0})});
    out.push_back(std::move(sensor));
    own += 1.3;
  }
  return out;
}

std::vector<WornSensor> worn(const std::vector<JudgeSensor>& sensors) {
  std::vector<WornSensor> out;
  for (const JudgeSensor& sensor : sensors) {
    out.push_back({sensor.name, sensor.track});
    for (auto& each : out.back().track) each.time += kShift;
  }
  return out;
}

TEST(Wearing, FindsTheLimbOfEachSensor) {
  auto sensors = worn(sensors_of(0.4, 8.0));
  std::swap(sensors[0], sensors[2]);
  const auto limbs = worn_on(sensors, body_of(0.4, 8.0));
  ASSERT_TRUE(limbs) << to_string(limbs.error());
  EXPECT_EQ(*limbs, (std::vector<Limb>{Limb::ThighRight, Limb::ShankLeft, Limb::ThighLeft}));
  EXPECT_FALSE(worn_on({}, body_of(0.4, 1.0)));
}

TEST(Wearing, RefusesWhatCouldBeExchangedWithWhatToDo) {
  TrackedBody body = body_of(0.4, 8.0);
  body[Limb::ThighRight] = body[Limb::ThighLeft];  // both legs alike
  const auto limbs = worn_on(worn(sensors_of(0.4, 8.0)), body);
  ASSERT_FALSE(limbs);
  EXPECT_NE(limbs.error().message.find("raise the"), std::string::npos) << limbs.error().message;
}

TEST(Wearing, FindsWhoWearsTheSuitAndRefusesWhileAllStandStill) {
  const auto sensors = worn(sensors_of(0.4, 6.0));
  const std::vector<Limb> limbs{Limb::ThighLeft, Limb::ShankLeft, Limb::ThighRight};
  const auto person =
      worn_by(sensors, limbs, {body_of(2.0, 6.0), body_of(0.4, 6.0), body_of(3.1, 6.0)});
  ASSERT_TRUE(person) << to_string(person.error());
  EXPECT_EQ(*person, 1u);
  TrackedBody still = body_of(0.4, 6.0);
  for (auto& [limb, track] : still)
    for (auto& each : track) each.value.world_from_limb.setIdentity();
  std::vector<WornSensor> resting = sensors;
  for (auto& sensor : resting)
    for (auto& each : sensor.track) each.value.setIdentity();
  EXPECT_FALSE(worn_by(resting, limbs, {still, still}));
  EXPECT_FALSE(worn_by(sensors, limbs, {}));
}

TEST(Wearing, AssignsAtLeastCost) {
  EXPECT_EQ(least_cost({{4, 1, 3}, {2, 0, 5}, {3, 2, 2}}), (std::vector<std::size_t>{1, 0, 2}));
  EXPECT_EQ(least_cost({{1, 0, 9}, {0, 9, 9}}), (std::vector<std::size_t>{1, 0}));
  EXPECT_TRUE(least_cost({}).empty());
}

TEST(Judge, FindsTheErrorAndNoOther) {
  TrackedBody body = body_of(0.4);
  for (auto& each : body[Limb::ShankLeft])
    if (each.time >= 14.0 && each.time <= 16.0)
      each.value.world_from_limb = each.value.world_from_limb * exp_map({1.4, 0, 0});
  auto sensors = sensors_of(0.4);
  sensors[0].limb = Limb::ThighLeft;
  sensors[1].limb = Limb::ShankLeft;
  sensors[2].limb = Limb::ThighRight;
  const auto found = judge_tracking(body, sensors);
  ASSERT_TRUE(found) << to_string(found.error());
  EXPECT_NEAR(found->shift.shift, kShift, 0.005);
  EXPECT_TRUE(found->refused.empty());
  ASSERT_EQ(found->limbs.size(), 3u);
  EXPECT_TRUE(found->limbs[0].detected.empty());
  ASSERT_EQ(found->limbs[1].detected.size(), 1u);
  EXPECT_NEAR(found->limbs[1].detected[0].begin, 14.0, 0.05);
  EXPECT_NEAR(found->limbs[1].detected[0].end, 16.0, 0.05);
  EXPECT_LT(found->limbs[1].floor.mean, deg(3));
  const auto rows =
      over_tau(found->limbs, {{Limb::ShankLeft, {14, 16}}}, inertial::LimbGroup::Legs);
  EXPECT_GT(*rows[7].counts.recall(), 0.95);        // at 45 degrees
  EXPECT_LT(rows.back().counts.true_positives, 1);  // at 120: the error has 80
}

/// Sensors that know their limbs.
std::vector<JudgeSensor> placed_sensors(double phase) {
  auto sensors = sensors_of(phase);
  sensors[0].limb = Limb::ThighLeft;
  sensors[1].limb = Limb::ShankLeft;
  sensors[2].limb = Limb::ThighRight;
  return sensors;
}

TEST(Judge, FindsWhoWearsTheSensors) {
  const auto sensors = placed_sensors(0.4);
  TrackedBody passer = body_of(0.4, 2.0);  // moves alike, but is seen for two seconds only
  const auto wearer = wearer_among({passer, body_of(2.0), body_of(0.4), body_of(3.1)}, sensors);
  ASSERT_TRUE(wearer) << to_string(wearer.error());
  EXPECT_EQ(*wearer, 2u);
  EXPECT_FALSE(wearer_among({body_of(0.4), body_of(0.4)}, sensors)) << "two who move alike";
  EXPECT_FALSE(wearer_among({}, sensors));
}

TEST(Judge, CarriesCalibrationsBackToTheBeginning) {
  TrackedBody body = body_of(0.4);
  for (auto& each : body[Limb::ShankLeft])
    if (each.time >= 1.0 && each.time <= 2.0)
      each.value.world_from_limb = each.value.world_from_limb * exp_map({1.4, 0, 0});
  auto sensors = placed_sensors(0.4);
  // The right thigh rests until 45 % of the take.
  for (auto& each : body[Limb::ThighRight])
    if (each.time < 9.0) each.value.world_from_limb = moved(9.0, 3.0);
  for (auto& each : sensors[2].track)
    if (each.time + kShift < 9.0)
      each.value = about_y(3.0) * moved(9.0, 3.0) * exp_map({3.0, 1, 0});
  EXPECT_EQ(judge_tracking(body, sensors)->refused.size(), 1u);
  JudgeOptions options;
  options.carry_back = true;
  const auto found = judge_tracking(body, sensors, options);
  ASSERT_TRUE(found) << to_string(found.error());
  EXPECT_DOUBLE_EQ(found->begin, 0.0);
  ASSERT_EQ(found->limbs.size(), 3u) << to_string(found->refused.front());
  ASSERT_EQ(found->limbs[1].detected.size(), 1u);
  EXPECT_NEAR(found->limbs[1].detected[0].begin, 1.0, 0.05);
  EXPECT_NEAR(found->limbs[1].detected[0].end, 2.0, 0.05);
  EXPECT_NEAR(found->limbs[1].calibrated_to, 7.0, 0.1);
  EXPECT_GT(found->limbs[2].calibrated_to, 9.0);
  EXPECT_TRUE(found->limbs[2].detected.empty());
}

TEST(Judge, ASensorThatSlipsIsWrongFromThenOnOnly) {
  auto sensors = placed_sensors(0.4);
  for (auto& each : sensors[1].track)
    if (each.time + kShift >= 12.0) each.value = each.value * exp_map({1.5, 0, 0});
  JudgeOptions options;
  options.carry_back = true;
  const auto found = judge_tracking(body_of(0.4), sensors, options);
  ASSERT_TRUE(found) << to_string(found.error());
  ASSERT_EQ(found->limbs[1].detected.size(), 1u);
  EXPECT_NEAR(found->limbs[1].detected[0].begin, 12.0, 0.05);
  EXPECT_GT(found->limbs[1].detected[0].end, 19.8);
}

TEST(Judge, TakesCalibrationsOfAnotherTakeAndRefusesAStillLimb) {
  auto sensors = sensors_of(0.4);
  sensors[0].limb = Limb::ThighLeft;
  sensors[1].limb = Limb::ShankLeft;
  sensors[2].limb = Limb::ThighRight;
  const auto calibrations = calibrate_take(body_of(0.4), sensors);
  ASSERT_TRUE(calibrations) << to_string(calibrations.error());
  EXPECT_EQ(calibrations->size(), 3u);
  const auto whole = judge_tracking(body_of(0.4), sensors, {}, *calibrations);
  ASSERT_TRUE(whole);
  EXPECT_DOUBLE_EQ(whole->begin, 0.0);
  TrackedBody stiff = body_of(0.4);
  for (auto& each : stiff[Limb::ThighRight]) each.value.world_from_limb.setIdentity();
  for (auto& each : sensors[2].track) each.value.setIdentity();
  const auto part = judge_tracking(stiff, sensors);
  ASSERT_TRUE(part) << to_string(part.error());
  ASSERT_EQ(part->refused.size(), 1u);
  EXPECT_NE(part->refused[0].context.find("right thigh"), std::string::npos);
  EXPECT_FALSE(judge_tracking({}, sensors));
}

}  // namespace
}  // namespace chorus::evaluation
