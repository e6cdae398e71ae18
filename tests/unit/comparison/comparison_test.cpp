#include "common/comparison/comparison.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/comparison/comparison_report.h"
#include "tests/support/builders.h"

namespace chorus::comparison {
namespace {

struct Planted {
  double noise = 0.005;  ///< [m], white
  double lag = 0.0;      ///< [s]
  double yaw = 0.0;      ///< [rad]
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Vector3d wrist = Eigen::Vector3d::Zero();
};

/// Somebody who walks curves and turns for 40 s, 30 frames a second.
Track walk(unsigned seed, const Planted& planted) {
  std::mt19937 random(seed);
  std::normal_distribution<double> white(0.0, planted.noise);
  const Eigen::AngleAxisd turn(planted.yaw, Eigen::Vector3d::UnitY());
  Track track;
  for (int i = 0; i < 700; ++i) {
    const double t = i / 30.0;
    const Eigen::Vector3d place(1.5 * std::sin(0.5 * t) + 0.4 * std::sin(1.7 * t), 0.0,
                                1.2 * std::sin(0.37 * t + 1.0));
    Skeleton<WorldSpace> body = testing::standing_person(place, 0.6 * t + std::sin(0.9 * t));
    for (Joint& joint : body.joints) {
      joint.position = turn * joint.position + planted.shift;
      for (Eigen::Index axis = 0; axis < 3; ++axis) joint.position[axis] += white(random);
    }
    body[JointId::WristLeft].position += planted.wrist;
    track.push_back({1000.0 + t + planted.lag, body});
  }
  return track;
}

Result<Comparison> compared(unsigned seed, const Planted& planted,
                            const CompareOptions& options = {}) {
  return compare({{1, walk(seed, {})}}, {{7, walk(seed + 1000, planted)}}, options);
}

CompareOptions one_clock() {
  CompareOptions options;
  options.same_clock = true;
  return options;
}

TEST(Comparison, SaysThatTwoRecordingsShareNoTime) {
  Planted hours;
  hours.lag = 7200.0;
  const auto found = compared(1, hours);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, ::testing::HasSubstr("share no time"));
  EXPECT_THAT(found.error().message, ::testing::HasSubstr("s after A ends"));
  EXPECT_THAT(found.error().message, ::testing::HasSubstr("--any-lag"));
}

TEST(Comparison, AdvisesNoOptionThatWasGivenOrIsNotItsOwn) {
  Track circles;
  for (int i = 0; i < 900; ++i) {
    const double t = i / 30.0;
    circles.push_back(
        {2e8 + t, testing::standing_person({std::sin(1.5 * t), 0.0, std::cos(1.5 * t)}, 0.0)});
  }
  CompareOptions options;
  for (const bool any : {true, false}) {
    options.clock_range = any ? std::nullopt : std::optional(6.0);
    const auto found = compare({{1, circles}}, {{1, circles}}, options);
    ASSERT_FALSE(found);
    const std::string& why = found.error().message;
    EXPECT_THAT(why, ::testing::HasSubstr("the motion repeats itself"));
    EXPECT_THAT(why, ::testing::HasSubstr("walk another way. If both have one clock"));
    EXPECT_EQ(why.find("--any-lag") == std::string::npos, any) << why;
    EXPECT_THAT(why, ::testing::Not(::testing::HasSubstr("--clock")));
  }
}

TEST(Comparison, CallsTwoDrawsOfOneMotionAlike) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto found = compared(seed, {}, one_clock());
    ASSERT_TRUE(found) << to_string(found.error());
    EXPECT_THAT(found->differences, ::testing::IsEmpty()) << seed;
  }
}

TEST(Comparison, FindsAShiftOfFiveMillimetres) {
  Planted planted;
  planted.shift = {0.0, 0.005, 0.0};
  const auto found = compared(1, planted, one_clock());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->offset[1].mean, -0.005, 0.002);
  EXPECT_THAT(found->differences, ::testing::ElementsAre(::testing::HasSubstr("along y")));
  CompareOptions options = one_clock();
  options.other_world = true;
  EXPECT_THAT(compared(1, planted, options)->differences, ::testing::IsEmpty());
}

TEST(Comparison, FindsATurnOfTwoDegrees) {
  Planted planted;
  planted.yaw = deg(2.0);
  const auto found = compared(2, planted, one_clock());
  ASSERT_TRUE(found);
  EXPECT_NEAR(to_deg(found->yaw.mean), -2.0, 0.2);
  EXPECT_THAT(found->differences, ::testing::Contains(::testing::HasSubstr("turned by -")));
}

TEST(Comparison, FindsALagAndTakesItOff) {
  Planted planted;
  planted.lag = 0.040;
  const auto found = compared(3, planted);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->lag, -0.040, 0.005);
  EXPECT_THAT(found->differences, ::testing::ElementsAre(::testing::HasSubstr("behind A")));
}

TEST(Comparison, NamesTheOneJointThatIsOff) {
  Planted planted;
  planted.wrist = {0.010, 0.0, 0.0};
  const auto found = compared(4, planted, one_clock());
  ASSERT_TRUE(found);
  EXPECT_THAT(found->differences,
              ::testing::Contains(::testing::HasSubstr("WristLeft of person 1")));
  const auto report = report_of(*found, {"a", "b", {}});
  EXPECT_THAT(report.verdict, ::testing::StartsWith("Different"));
  EXPECT_EQ(report.judgement, report::Judgement::Doubtful);
}

TEST(Comparison, MatchesPeopleWhateverTheirIds) {
  Track second = walk(5, {});
  for (Moment& moment : second)
    for (Joint& joint : moment.body.joints) joint.position.x() += 3.0;
  second.resize(400);
  const auto found =
      compare({{1, walk(6, {})}, {2, second}}, {{9, second}, {4, walk(8, {})}}, one_clock());
  ASSERT_TRUE(found) << to_string(found.error());
  ASSERT_EQ(found->pairs.size(), 2u);
  EXPECT_EQ(found->pairs[0].b, 4u);
  EXPECT_EQ(found->pairs[1].b, 9u);
}

TEST(Comparison, RefusesWhatCannotBeCompared) {
  EXPECT_EQ(compare({}, {{1, walk(1, {})}}, {}).error().code, ErrorCode::NotFound);
  Planted late;
  late.lag = 500.0;
  EXPECT_EQ(compared(1, late, one_clock()).error().code, ErrorCode::NotFound);
  Track backwards = walk(1, {});
  std::swap(backwards.front(), backwards.back());
  EXPECT_EQ(compare({{1, backwards}}, {{1, walk(1, {})}}, {}).error().code,
            ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace chorus::comparison
