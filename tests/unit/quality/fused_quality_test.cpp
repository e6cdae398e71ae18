#include "common/quality/fused_quality.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/unit/quality/standing_person.h"

namespace chorus::quality {
namespace {

constexpr auto kWrist = static_cast<std::size_t>(JointId::WristLeft);

TEST(FusedQuality, OfNothingIsNothing) {
  const FusedQuality quality = FusedJudge().finish();
  EXPECT_EQ(quality.frames, 0U);
  EXPECT_TRUE(quality.people.empty());
}

TEST(FusedQuality, CountsCoverageAndGapsOfAJoint) {
  FusedJudge judge;
  for (int i = 0; i < 100; ++i) {
    auto body = body_at(1, walking(i));
    if (i >= 40 && i < 60) body.joints[kWrist].state = JointState::NotTracked;
    if (i >= 80) body.joints[kWrist].state = JointState::Inferred;
    judge.add(frame_at(i, {body}));
  }
  const JointQuality wrist = judge.finish().joints[kWrist];
  EXPECT_NEAR(wrist.missing, 0.2, 1e-9);
  EXPECT_NEAR(wrist.inferred, 0.2, 1e-9);
  EXPECT_NEAR(wrist.tracked, 0.6, 1e-9);
  EXPECT_EQ(wrist.gaps, 1);
  EXPECT_NEAR(wrist.longest_gap, 19 * 0.033333, 1e-6);
  EXPECT_NEAR(wrist.longest_gap_at, 40 * 0.033333, 1e-6);
  EXPECT_NEAR(wrist.sensors, 2.0, 1e-9);
}

TEST(FusedQuality, MeasuresJitterAtRestAndInMotionAsTheNoiseOfOneAxis) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.002);
  for (const double speed : {0.0, 1.2}) {
    FusedJudge judge;
    for (int i = 0; i < 3000; ++i) {
      auto body = body_at(1, {speed * i / 30.0, 0.0, 0.0});
      for (auto& joint : body.joints)
        joint.position += Eigen::Vector3d(noise(random), noise(random), noise(random));
      judge.add(frame_at(i, {body}));
    }
    const JointQuality wrist = judge.finish().joints[kWrist];
    EXPECT_NEAR(speed > 0.0 ? wrist.jitter_in_motion : wrist.jitter_at_rest, 0.002, 0.0002)
        << speed;
    EXPECT_EQ(wrist.jumps, 0);
  }
}

TEST(FusedQuality, CountsJumpsPausesAndBoneLengths) {
  FusedJudge judge;
  for (int i = 0; i < 300; ++i) {
    auto body = body_at(1, walking(i));
    if (i == 150) body.joints[kWrist].position.x() += 0.3;
    judge.add(frame_at(i < 200 ? i : i + 30, {body}));
  }
  const FusedQuality quality = judge.finish();
  EXPECT_GE(quality.joints[kWrist].jumps, 1);
  EXPECT_EQ(quality.joints[static_cast<std::size_t>(JointId::Head)].jumps, 0);
  EXPECT_EQ(quality.pauses, 1);
  EXPECT_NEAR(quality.longest_pause, 31 * 0.033333, 1e-6);
  EXPECT_NEAR(quality.rate, 30.0, 0.01);
  EXPECT_GT(quality.people.at(0).bones[6].variation, 0.01);  // elbow to wrist
  EXPECT_LT(quality.people.at(0).bones[0].variation, 1e-6);
}

TEST(FusedQuality, NamesIdsThatWereHandedOnAndPeopleWhoCameBackElsewhereNot) {
  FusedJudge judge;
  for (int i = 0; i < 60; ++i) judge.add(frame_at(i, {body_at(1, walking(i))}));
  for (int i = 60; i < 120; ++i)
    judge.add(
        frame_at(i, {body_at(2, walking(i)), body_at(3, walking(i) + Eigen::Vector3d(3, 0, 0))}));
  const FusedQuality quality = judge.finish();
  ASSERT_EQ(quality.switches.size(), 1U);
  EXPECT_EQ(quality.switches[0].person, 2U);
}

TEST(FusedQuality, NamesAPersonWhoIsPublishedTwiceOnlyWhenItLasts) {
  const auto with = [](int from, int to) {
    FusedJudge judge;
    for (int i = 0; i < 90; ++i) {
      std::vector<resource::BodyResource> bodies{body_at(1, walking(i))};
      if (i >= from && i < to)
        bodies.push_back(body_at(2, walking(i) + Eigen::Vector3d(0.1, 0, 0)));
      judge.add(frame_at(i, bodies));
    }
    return judge.finish().doubles.size();
  };
  EXPECT_EQ(with(10, 80), 1U);
  EXPECT_EQ(with(10, 20), 0U);
}

TEST(FusedQuality, NamesExchangedSides) {
  FusedJudge judge;
  for (int i = 0; i < 60; ++i) {
    auto body = body_at(1, walking(i));
    if (i == 30)
      for (const auto& [left, right] : kMirrorPairs)
        std::swap(body.joints[index_of(left)], body.joints[index_of(right)]);
    body.sides_confidence = i < 30 ? 0.99 : 0.6;
    judge.add(frame_at(i, {body}));
  }
  const FusedQuality quality = judge.finish();
  EXPECT_EQ(quality.turned.size(), 2U) << "there and back";
  EXPECT_NEAR(quality.people.at(0).least_certain_sides, 0.6, 1e-9);
  EXPECT_NEAR(quality.people.at(0).uncertain_sides, 0.5, 1e-9);
}

}  // namespace
}  // namespace chorus::quality
