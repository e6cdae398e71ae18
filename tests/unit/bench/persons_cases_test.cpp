#include "tests/bench/accuracy/persons_cases.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace chorus::bench {
namespace {

PersonsCase case_of(const std::string& name, Duration length) {
  const auto cases = persons_cases();
  PersonsCase found = *std::ranges::find(cases, name, &PersonsCase::name);
  found.length = length;
  return found;
}

TEST(PersonsCases, HaveTheNamesOfTheProductAndTwentyDraws) {
  const auto cases = persons_cases();
  for (const char* name : {"crossing-2", "four-5min"}) {
    EXPECT_NE(std::ranges::find(cases, name, &PersonsCase::name), cases.end()) << name;
  }
  for (const PersonsCase& each : cases) EXPECT_GE(each.draws, 20u) << each.name;
  EXPECT_EQ(std::ranges::find(cases, "four-5min", &PersonsCase::name)->length,
            std::chrono::minutes(5));
}

TEST(PersonsCases, WhoCrossesUnseenKeepsTheIdByPredictionOnly) {
  const PersonsCase hidden = case_of("crossing-2-hidden", std::chrono::seconds(30));
  std::size_t ours = 0;
  std::size_t nearest = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Identities found = identities_in(hidden, seed, {{"ours"}});
    ours += found.at("ours").switches;
    nearest += found.at("nearest-neighbour").switches;
  }
  EXPECT_GT(nearest, ours);
}

TEST(PersonsCases, AdjustedParametersReachTheSensors) {
  PersonsCase each = case_of("crossing-2-ring3", std::chrono::seconds(10));
  each.adjust = [](synthetic::kinect::Profile& profile, std::size_t) {
    profile.delivery.drop_share = 0.9;
  };
  const Identities thinned = identities_in(each, 1, {{"ours"}});
  each.adjust = [](synthetic::kinect::Profile&, std::size_t) {};
  const Identities usual = identities_in(each, 1, {{"ours"}});
  EXPECT_LT(thinned.at("ours").coverage, usual.at("ours").coverage);
  each.adjust = {};
  EXPECT_EQ(identities_in(each, 1, {{"ours"}}).at("ours").idf1, usual.at("ours").idf1);
}

TEST(PersonsCases, OfTwoAtWorkTellWhoseSidesAreWrong) {
  PersonsCase each = case_of("side-2-ring3", std::chrono::seconds(3));
  EXPECT_TRUE(each.sides);
  const double wrong = sides_wrong_in(each, 1);
  EXPECT_GE(wrong, 0.0);
  EXPECT_LT(wrong, 1.0);
}

}  // namespace
}  // namespace chorus::bench
