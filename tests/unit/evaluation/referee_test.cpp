// A reference beside tracker and sensors: whose error a disagreement is.
#include "common/evaluation/referee.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

constexpr double kLength = 24.0;  // [s]
constexpr Limb kLimbs[] = {Limb::ThighLeft, Limb::ShankLeft, Limb::ThighRight};

/// A movement that gets faster, so that it is never like itself later.
Eigen::Quaterniond turned(double time, double phase) {
  const double t = time + 0.02 * time * time;
  return exp_map({0.8 * std::sin(1.1 * t + phase), 0.9 * std::sin(0.7 * t + 2 * phase),
                  0.7 * std::cos(1.7 * t - phase)});
}

/// Somebody's limbs from `begin` on, at a rate, by a clock that is `late` behind the truth.
TrackedBody limbs(double rate, double begin, double length, double late) {
  TrackedBody out;
  double phase = 0.4;
  for (const Limb limb : kLimbs) {
    for (int i = 0; i < static_cast<int>(length * rate); ++i) {
      const double t = begin + i / rate;
      out[limb].push_back({t - late, {turned(t, phase), Eigen::Matrix3d::Zero(), true}});
    }
    phase += 1.3;
  }
  return out;
}

std::vector<JudgeSensor> suit() {
  std::vector<JudgeSensor> out;
  double phase = 0.4;
  for (const Limb limb : kLimbs) {
    JudgeSensor sensor{std::string(name_of(limb)), limb, {}};
    for (int i = 0; i < static_cast<int>(kLength * 100); ++i)
      sensor.track.push_back(
          {i / 100.0, about_y(phase) * turned(i / 100.0, phase) * exp_map({phase, 1, 0})});
    out.push_back(std::move(sensor));
    phase += 1.3;
  }
  return out;
}

const RefereedLimb& of(const std::vector<RefereedLimb>& all, Limb limb) {
  return *std::ranges::find(all, limb, &RefereedLimb::limb);
}

TEST(Referee, TellsWhoErrsWhereTheyDisagree) {
  TrackedBody body = limbs(30, 0, kLength, 0);
  for (auto& each : body[Limb::ShankLeft])  // the tracker errs
    if (each.time >= 14.0 && each.time <= 16.0)
      each.value.world_from_limb = each.value.world_from_limb * exp_map({1.4, 0, 0});
  auto sensors = suit();
  for (auto& each : sensors[2].track)  // a sensor is turned, and turned back
    if (each.time >= 17.0 && each.time <= 21.0)
      each.value = each.value * exp_map({0, 0, 1.4 * std::sin(0.785398 * (each.time - 17.0))});
  const auto found = judge_tracking(body, sensors);
  ASSERT_TRUE(found) << to_string(found.error());
  const auto reference = limbs(100, 0, kLength, 0);
  const auto refereed_limbs = refereed(*found, body, sensors, reference, deg(45));
  ASSERT_EQ(refereed_limbs.size(), 3u);
  const RefereedLimb& shank = of(refereed_limbs, Limb::ShankLeft);
  ASSERT_EQ(shank.segments.size(), 1u);
  EXPECT_EQ(shank.segments[0].right, Right::Sensor);
  EXPECT_NEAR(shank.segments[0].tracker, 1.4, 0.05);
  EXPECT_LT(shank.segments[0].sensor, deg(5));
  EXPECT_NEAR(static_cast<double>(shank.instants[1]), 60, 4);
  EXPECT_LT(shank.tracker_spread.median, deg(1));
  const RefereedLimb& thigh = of(refereed_limbs, Limb::ThighRight);
  ASSERT_EQ(thigh.segments.size(), 1u);
  EXPECT_EQ(thigh.segments[0].right, Right::Tracker);
  EXPECT_NEAR(thigh.segments[0].sensor, 1.2, 0.15);
  EXPECT_EQ(of(refereed_limbs, Limb::ThighLeft).disagreements(), 0u);
}

TEST(Referee, SaysNothingOfWhatTheReferenceDoesNotShow) {
  const TrackedBody body = limbs(30, 0, kLength, 0);
  const auto sensors = suit();
  const auto found = judge_tracking(body, sensors);
  ASSERT_TRUE(found);
  TrackedBody reference = limbs(100, 0, kLength, 0);
  reference.erase(Limb::ThighRight);
  std::erase_if(reference[Limb::ShankLeft], [](const auto& each) { return each.time > 5.0; });
  const auto all = refereed(*found, body, sensors, reference, deg(45));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].limb, Limb::ThighLeft);
}

TEST(Referee, FindsWhenTheReferenceWasRecorded) {
  const TrackedBody body = limbs(30, 0, kLength, 0);
  for (const double begin : {3.0, 9.5}) {
    TrackedBody reference = limbs(100, begin, kLength, begin);  // its clock begins at 0
    for (auto& [limb, track] : reference)
      for (auto& each : track)
        each.value.world_from_limb = exp_map({0.1, 2.0, 0}) * each.value.world_from_limb;
    const auto shift = reference_shift(body, reference);
    ASSERT_TRUE(shift) << to_string(shift.error());
    EXPECT_NEAR(shift->shift, begin, 0.005);
  }
}

TEST(Referee, RefusesATimeThatIsNotShared) {
  const TrackedBody body = limbs(30, 0, kLength, 0);
  const auto later = reference_shift(body, limbs(100, 60.0, kLength, 60.0));
  ASSERT_FALSE(later) << later->shift << " " << later->correlation;
  EXPECT_EQ(later.error().code, ErrorCode::Conflict);
  const auto brief = reference_shift(body, limbs(100, 3.0, 2.0, 0.0));
  ASSERT_FALSE(brief);
  EXPECT_NE(brief.error().message.find("each needs 5"), std::string::npos);
  EXPECT_FALSE(reference_shift(body, {}));
  TrackedBody others;
  others[Limb::ForearmLeft] = body.at(Limb::ThighLeft);
  EXPECT_FALSE(reference_shift(body, others));
}

TEST(Referee, TheNearerIsRightIfItIsWithinTau) {
  EXPECT_EQ(who_is_right(0.1, 0.9, 0.8), Right::Tracker);
  EXPECT_EQ(who_is_right(0.9, 0.1, 0.8), Right::Sensor);
  EXPECT_EQ(who_is_right(0.9, 1.0, 0.8), Right::Neither);
  EXPECT_EQ(who_is_right(std::nan(""), std::nan(""), 0.8), Right::Neither);
}

}  // namespace
}  // namespace chorus::evaluation
