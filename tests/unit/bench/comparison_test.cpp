#include "tests/bench/methods/comparison.h"

#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "tests/bench/methods/over_draws.h"

namespace chorus::bench {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Comparison three_draws() {
  Comparison comparison("pair", "position_mm", "mm");
  for (const double value : {1.0, 2.0, kNone}) {
    comparison.add(kOurs, static_cast<std::size_t>(std::isnan(value) ? 3 : value), value);
  }
  return comparison;
}

TEST(Comparison, CountsADrawWithoutValueAsFailedAndInfinitelyBad) {
  const Spread ours = three_draws().spread_of(kOurs);
  EXPECT_EQ(ours.failed, 1u);
  EXPECT_EQ(ours.draws, 3u);
  EXPECT_DOUBLE_EQ(ours.median, 2.0);
  EXPECT_TRUE(std::isinf(ours.high));
  EXPECT_DOUBLE_EQ(ours.low, 1.1);
}

TEST(Comparison, WinsOnlyWhereStrictlyBetterOnTheSameDraw) {
  Comparison comparison = three_draws();
  comparison.add("equal-and-failed", 1, 1.0);
  comparison.add("equal-and-failed", 3, kNone);
  comparison.add("worse", 3, 9.0);  // our method failed for this seed
  comparison.add("worse", 2, 9.0);
  comparison.add("worse", 1, kNone);
  EXPECT_DOUBLE_EQ(comparison.won_percent("equal-and-failed"), 0.0);
  EXPECT_NEAR(comparison.won_percent("worse"), 200.0 / 3.0, 1e-9);
  EXPECT_TRUE(std::isnan(comparison.won_percent("nobody")));
}

TEST(Comparison, WhereHigherIsBetterAFailedDrawIsTheLowest) {
  Comparison comparison("crossing", "idf1", "%", Better::Higher);
  for (const auto& [draw, value] : {std::pair{1, 90.0}, {2, 80.0}, {3, kNone}}) {
    comparison.add(kOurs, static_cast<std::size_t>(draw), value);
    comparison.add("icp", static_cast<std::size_t>(draw), 85.0);
  }
  const Spread ours = comparison.spread_of(kOurs);
  EXPECT_DOUBLE_EQ(ours.median, 80.0);
  EXPECT_DOUBLE_EQ(ours.high, 89.0);
  EXPECT_EQ(ours.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(ours.failed, 1u);
  EXPECT_NEAR(comparison.won_percent("icp"), 100.0 / 3.0, 1e-9);
}

TEST(Comparison, ReportsWinsAsRowsOfTheirOwn) {
  Report report({"registration", 1, false});
  Comparison comparison = three_draws();
  comparison.add("icp", 1, 4.0);
  comparison.report_wins(report);
  ASSERT_EQ(report.rows().size(), 1u);
  EXPECT_EQ(report.rows()[0].metric, "win_percent");
  EXPECT_EQ(report.rows()[0].baseline, "icp");
  EXPECT_DOUBLE_EQ(report.rows()[0].value, 100.0);
}

TEST(Comparison, ReportsOneRowPerBaselineAndOursAloneWithoutAny) {
  Report report({"registration", 1, false});
  three_draws().report(report);
  ASSERT_EQ(report.rows().size(), 1u);
  EXPECT_EQ(report.rows()[0].baseline, "");
  Comparison comparison = three_draws();
  comparison.add("icp", 1, 4.0);
  comparison.add("lost", 1, kNone);
  comparison.report(report);
  ASSERT_EQ(report.rows().size(), 3u);
  EXPECT_EQ(report.rows()[1].baseline, "icp");
  EXPECT_DOUBLE_EQ(report.rows()[1].ratio, 0.5);
  EXPECT_DOUBLE_EQ(report.rows()[1].value, 2.0);
  EXPECT_TRUE(std::isnan(report.rows()[2].ratio));
  EXPECT_EQ(report.rows()[2].beside->failed, 1u);
}

TEST(OverDraws, KeepsTheOrderOfTheDraws) {
  const auto squares = over_draws(100, [](std::size_t i) { return i * i; });
  ASSERT_EQ(squares.size(), 100u);
  for (std::size_t i = 0; i < squares.size(); ++i) EXPECT_EQ(squares[i], i * i);
  EXPECT_TRUE(over_draws(0, [](std::size_t i) { return i; }).empty());
}

}  // namespace
}  // namespace chorus::bench
