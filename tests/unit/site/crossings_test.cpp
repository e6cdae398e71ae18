#include "tests/bench/site/crossings.h"

#include <gtest/gtest.h>

#include "tests/bench/site/cascade.h"
#include "tests/judge/hall_scenes.h"

namespace chorus::bench {
namespace {

constexpr double kTick = 0.1;

/// One person, seen by cell 0 until 5 s and by cell 1 from `enters` on, under these ids.
CrossingScore crossing(double enters, const std::string& before, const std::string& after,
                       bool doubtful = false) {
  Crossings crossings(kTick);
  for (double time = 0.0; time < 10.0; time += kTick) {
    std::vector<SeenAs> seen{{2, 1, "other", false}};
    if (time < 5.0) seen.push_back({0, 0, before, false});
    if (time >= enters) seen.push_back({1, 0, after, doubtful});
    crossings.add(time, seen);
  }
  return crossings.score();
}

TEST(Crossings, CountWhoKeepsTheirId) {
  const CrossingScore kept = crossing(4.0, "a", "a");
  EXPECT_EQ(kept.overlap.all, 1U);
  EXPECT_EQ(kept.overlap.kept, 1U);
  EXPECT_EQ(kept.gap.all, 0U);
  const CrossingScore lost = crossing(4.0, "a", "b");
  EXPECT_EQ(lost.overlap.kept, 0U);
  EXPECT_EQ(lost.overlap.wrong, 0U);
  EXPECT_GT(lost.doubled_per_minute, 0.0);
}

TEST(Crossings, TellGapsFromOverlaps) {
  EXPECT_EQ(crossing(7.0, "a", "a").gap.kept, 1U);
  EXPECT_EQ(crossing(9.5, "a", "a").gap.all, 0U);  // after too long a time
}

TEST(Crossings, CountIdsOfOthersAsWrong) {
  EXPECT_EQ(crossing(4.0, "a", "other").overlap.wrong_unsaid, 1U);
  const CrossingScore doubted = crossing(4.0, "a", "other", true);
  EXPECT_EQ(doubted.overlap.wrong, 1U);
  EXPECT_EQ(doubted.overlap.wrong_unsaid, 0U);
  EXPECT_GT(doubted.doubtful_percent, 0.0);
}

TEST(AHall, KeepsItsPeople) {
  // Half a minute of hall-8x8; `chorus-bench site` has the figures.  One wrong id may be among some
  // thirty crossings.
  Hall hall(eight_cells(3), people_in_hall(3, 12, 30.0), 3);
  Crossings crossings(Hall::kPeriod);
  OverSite over_site;
  while (hall.time() < 30.0) {
    hall.step();
    crossings.add(hall.time(), over_site.at(hall).seen);
  }
  const CrossingScore score = crossings.score();
  EXPECT_GE(score.overlap.all, 5U);
  EXPECT_EQ(score.overlap.kept, score.overlap.all);
  EXPECT_LE(score.overlap.wrong + score.gap.wrong_unsaid, 1U);
}

}  // namespace
}  // namespace chorus::bench
