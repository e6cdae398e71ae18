// The sensors' shares in a joint, as a list on the wire.
#include "common/resource/frame_shares.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::resource {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The frame's sensors; their ids are in another order than their bits.
const std::vector<std::string> kSensors{"s3", "s1", "s2"};
constexpr std::uint64_t kS3 = 0b001;
constexpr std::uint64_t kS1 = 0b010;
constexpr std::uint64_t kS2 = 0b100;
constexpr std::uint64_t kAll = kS1 | kS2 | kS3;

Shares shares(unsigned s3, unsigned s1, unsigned s2) {
  Shares::Hundredths hundredths{};
  hundredths[0] = static_cast<std::uint8_t>(s3);
  hundredths[1] = static_cast<std::uint8_t>(s1);
  hundredths[2] = static_cast<std::uint8_t>(s2);
  return Shares(hundredths);
}

std::vector<double> written(const Shares& of, std::uint64_t contributors) {
  ShareList::Values values{};
  const auto list = ShareList(kSensors).of(of, contributors, values);
  return {list.begin(), list.end()};
}

std::optional<Shares> read(const std::vector<double>& list, std::uint64_t contributors) {
  return ShareList(kSensors).read(std::span(list), contributors);
}

TEST(ShareList, IsInTheOrderOfTheSensorsIds) {
  EXPECT_THAT(written(shares(20, 50, 30), kAll),
              ElementsAre(DoubleEq(0.5), DoubleEq(0.3), DoubleEq(0.2)));
  EXPECT_THAT(written(shares(60, 0, 40), kS2 | kS3), ElementsAre(DoubleEq(0.4), DoubleEq(0.6)));
}

TEST(ShareList, ReadsBackWhatItWrote) {
  for (const Shares& each : {shares(20, 50, 30), shares(1, 98, 1), shares(100, 0, 0)})
    EXPECT_EQ(read(written(each, kAll), kAll), each);
}

TEST(ShareList, OneContributorHasAllAndNeedsNoList) {
  EXPECT_THAT(written(shares(0, 100, 0), kS1), IsEmpty());
  const auto all = ShareList(kSensors).read(std::nullopt, kS1);
  ASSERT_TRUE(all);
  EXPECT_EQ(*all, shares(0, 100, 0));
  EXPECT_EQ(read({1.0}, kS1), shares(0, 100, 0)) << "but may have one";
}

TEST(ShareList, SeveralWithoutAListAreNotKnown) {
  EXPECT_THAT(written(Shares(), kAll), IsEmpty());
  const auto none = ShareList(kSensors).read(std::nullopt, kAll);
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->known());
  const auto nobody = ShareList(kSensors).read(std::nullopt, 0);
  ASSERT_TRUE(nobody);
  EXPECT_FALSE(nobody->known());
}

TEST(ShareList, WhatReadersWouldRefuseIsNotWritten) {
  EXPECT_THAT(written(shares(20, 50, 0), kAll), IsEmpty()) << "these make 0.7";
  EXPECT_THAT(written(shares(20, 50, 30), kS1 | kS2), IsEmpty()) << "a fifth is somebody else's";
}

TEST(ShareList, NeedsOneShareForEachContributor) {
  EXPECT_FALSE(read({0.5, 0.5}, kAll));
  EXPECT_FALSE(read({0.5, 0.3, 0.2}, kS1 | kS2));
  EXPECT_FALSE(read({}, kS1));
  EXPECT_FALSE(read({1.0}, 0));
}

TEST(ShareList, RefusesSharesThatAreNone) {
  EXPECT_FALSE(read({1.2, -0.2}, kS1 | kS2));
  EXPECT_FALSE(read({1.01, 0.0}, kS1 | kS2));
  EXPECT_FALSE(read({std::nan(""), 1.0}, kS1 | kS2));
  EXPECT_FALSE(read({0.4, 0.4}, kS1 | kS2)) << "a fifth is missing";
}

TEST(ShareList, ForgivesTheRoundingOfOthers) {
  const auto thirds = read({0.333, 0.333, 0.333}, kAll);
  ASSERT_TRUE(thirds);
  double sum = 0.0;
  for (std::size_t i = 0; i < kSensors.size(); ++i) {
    EXPECT_NEAR(thirds->of(i), 1.0 / 3.0, 0.011);
    sum += thirds->of(i);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12) << "ours make exactly one again";
  EXPECT_TRUE(read({0.505, 0.51}, kS1 | kS2)) << "up to a hundredth for each of two";
  EXPECT_FALSE(read({0.52, 0.51}, kS1 | kS2));
}

TEST(ShareList, KeepsTheirProportion) {
  const auto read_back = read({0.251, 0.751}, kS1 | kS2);
  ASSERT_TRUE(read_back);
  EXPECT_NEAR(read_back->of(1), 0.25, 0.011) << "s1";
  EXPECT_NEAR(read_back->of(2), 0.75, 0.011) << "s2";
  EXPECT_EQ(read_back->of(0), 0.0) << "s3 did not contribute";
}

TEST(ShareList, SensorsBeyondTheBitsAreLeftOut) {
  std::vector<std::string> many;
  for (int i = 0; i < 80; ++i) many.push_back("s" + std::to_string(100 + i));
  ShareList::Values values{};
  const ShareList list(many);
  EXPECT_EQ(list.of(shares(50, 50, 0), 0b011, values).size(), 2U);
}

}  // namespace
}  // namespace chorus::resource
