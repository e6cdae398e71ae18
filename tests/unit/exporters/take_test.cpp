#include "common/exporters/take.h"

#include <gmock/gmock.h>

#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::exporters {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using chorus::testing::standing_person;
using ::testing::HasSubstr;

FusedSample sample(Timestamp instant, std::uint64_t person, double x, double variance = 1e-4) {
  FusedSample out{instant, PersonId{person}, standing_person({x, 0, 0})};
  out.variance.fill(variance);
  return out;
}

double x_of(const Pose& pose) { return pose.skeleton[JointId::SpineBase].position.x(); }
bool missing(const Pose& pose) { return !pose.skeleton[JointId::SpineBase].seen(); }

TEST(Take, KeepsSamplesOfAUniformSourceAsTheyAre) {
  std::vector<FusedSample> samples;
  for (int i = 0; i < 31; ++i) {
    // A grid that starts at a rounded instant misses every third of these by a nanosecond.
    const auto instant =
        kStart + Duration((2 * (i + 2) * std::int64_t{1'000'000'000} / 30 + 1) / 2);
    samples.push_back(sample(instant, 1, 0.01 * i * i));
  }
  const auto take = make_take(samples);
  ASSERT_THAT(take, IsOk());
  EXPECT_EQ(take->rate_hz, 30.0);
  ASSERT_EQ(take->frames, 31u);
  EXPECT_EQ(take->start, samples.front().instant);
  for (int i = 0; i < 31; ++i) {
    const Pose& pose = take->persons[0].poses[static_cast<std::size_t>(i)];
    EXPECT_EQ(x_of(pose), 0.01 * i * i) << i;
    EXPECT_EQ(instant_of(*take, static_cast<std::size_t>(i)),
              samples[static_cast<std::size_t>(i)].instant);
    EXPECT_EQ(pose.variance[3], 1e-4);
  }
}

TEST(Take, BridgesShortHolesAndLeavesLongOnes) {
  std::vector<FusedSample> samples;
  for (const int i : {0, 1, 2, 3, 5, 6, 7, 8, 20, 21})
    samples.push_back(sample(kStart + i * std::chrono::milliseconds(40), 1, i));
  const auto take = make_take(samples, {.max_gap = std::chrono::milliseconds(100)});
  ASSERT_THAT(take, IsOk());
  EXPECT_EQ(take->rate_hz, 25.0);
  ASSERT_EQ(take->frames, 22u);
  const auto& poses = take->persons[0].poses;
  EXPECT_NEAR(x_of(poses[4]), 4.0, 1e-9) << "between 3 and 5";
  EXPECT_NEAR(poses[4].variance[0], 1e-4, 1e-12);
  EXPECT_TRUE(missing(poses[9]));
  EXPECT_TRUE(missing(poses[19]));
  EXPECT_EQ(x_of(poses[20]), 20.0);
}

TEST(Take, ResamplesToTheRateAsked) {
  std::vector<FusedSample> samples;
  for (int i = 0; i <= 10; ++i)
    samples.push_back(sample(kStart + i * std::chrono::milliseconds(100), 1, i));
  const auto take = make_take(samples, {.rate_hz = 25.0});
  ASSERT_THAT(take, IsOk());
  ASSERT_EQ(take->frames, 26u);
  for (std::size_t f = 0; f < take->frames; ++f)
    EXPECT_NEAR(x_of(take->persons[0].poses[f]), 0.4 * static_cast<double>(f), 1e-6);
}

TEST(Take, ARateThatIsNoWholeNumberOfHertzKeepsItsLastFrame) {
  std::vector<FusedSample> samples;
  constexpr double kStep = 8332986.11;  // [ns]; BVH files round it to 0.008333 s
  for (int i = 0; i < 40'000; ++i)
    samples.push_back({kStart + Duration(std::llround(kStep * i)), PersonId{1}, {}});
  const auto take = make_take(samples);
  ASSERT_THAT(take, IsOk());
  EXPECT_EQ(take->frames, 40'000u);
  EXPECT_NEAR(take->rate_hz, 1e9 / kStep, 1e-6);
}

TEST(Take, PutsPersonsOnOneGridInOrderOfTheirIds) {
  const auto take =
      make_take({sample(kStart, 7, 0), sample(kStart + kFrameInterval, 7, 1),
                 sample(kStart + kFrameInterval, 3, 2), sample(kStart + 2 * kFrameInterval, 3, 3)});
  ASSERT_THAT(take, IsOk());
  ASSERT_EQ(take->persons.size(), 2u);
  EXPECT_EQ(take->persons[0].person, PersonId{3});
  EXPECT_EQ(take->frames, 3u);
  EXPECT_TRUE(missing(take->persons[0].poses[0]));
  EXPECT_EQ(x_of(take->persons[0].poses[2]), 3.0);
  EXPECT_TRUE(missing(take->persons[1].poses[2]));
}

TEST(Take, OnePersonAloneOrAReasonWhyNot) {
  const std::vector samples{sample(kStart, 7, 0), sample(kStart + kFrameInterval, 3, 1)};
  const auto alone = make_take(samples, {.person = PersonId{3}});
  ASSERT_THAT(alone, IsOk());
  EXPECT_EQ(alone->frames, 1u);
  EXPECT_EQ(alone->start, kStart + kFrameInterval);
  const auto nobody = make_take(samples, {.person = PersonId{9}});
  ASSERT_THAT(nobody, FailsWith(ErrorCode::NotFound));
  EXPECT_THAT(to_string(nobody.error()), HasSubstr("there are: 3 7"));
}

TEST(Take, RefusesNothingTwiceAndTooMuch) {
  EXPECT_THAT(make_take({}), FailsWith(ErrorCode::NotFound));
  EXPECT_THAT(make_take({sample(kStart, 1, 0), sample(kStart, 1, 1)}),
              FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(make_take({sample(kStart, 1, 0)}, {.rate_hz = -1}),
              FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(make_take({sample(kStart, 1, 0), sample(kStart + std::chrono::hours(24), 1, 0)},
                        {.rate_hz = 30}),
              FailsWith(ErrorCode::TooLarge));
}

TEST(Take, ASingleSampleIsOneFrame) {
  const auto take = make_take({sample(kStart, 1, 5)});
  ASSERT_THAT(take, IsOk());
  EXPECT_EQ(take->frames, 1u);
  EXPECT_EQ(x_of(take->persons[0].poses[0]), 5.0);
}

}  // namespace
}  // namespace chorus::exporters
