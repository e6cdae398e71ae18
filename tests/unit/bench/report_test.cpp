#include "tests/bench/report/report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Report two_rows() {
  Report report({"registration", 7, true});
  report.profile("gauss");
  report.row("pair", "position_mm", 5.0, "mm", "icp", 0.25);
  report.row("pair", "refused_percent", kNan, "%");
  return report;
}

TEST(Report, TableIsAlignedAndNamesTheBaselinesValue) {
  std::ostringstream out;
  two_rows().print(out);
  EXPECT_THAT(out.str(), HasSubstr("case  metric           value  unit  baseline  ratio\n"));
  EXPECT_THAT(out.str(), HasSubstr("pair  position_mm          5  mm    icp 20     0.25\n"));
  EXPECT_THAT(out.str(), HasSubstr("pair  refused_percent      -  %\n"));
  EXPECT_THAT(out.str(), HasSubstr("quick: indicative only"));
}

TEST(Report, RowsOverDrawsShowRangesFailuresAndWins) {
  Report report({"registration", 1, false});
  Row row{"pair", "position_mm", 5.0, "mm", "icp", 0.5};
  row.spread = Spread{5.0, 1.0, 9.0, 0, 20};
  row.beside = Spread{10.0, 4.0, std::numeric_limits<double>::infinity(), 3, 20};
  row.won_percent = 85.0;
  report.row(row);
  std::ostringstream out;
  report.print(out);
  EXPECT_THAT(out.str(),
              HasSubstr("pair  position_mm      5  mm    1 .. 9  0/20    icp 10    4 .. -  3/20"
                        "      0.5  85 %\n"));
  const auto json = nlohmann::json::parse(report.json());
  EXPECT_EQ(json["rows"][0]["spread"]["p95"], 9.0);
  EXPECT_TRUE(json["rows"][0]["beside"]["p95"].is_null());
  EXPECT_EQ(json["rows"][0]["beside"]["failed"], 3);
  EXPECT_EQ(json["rows"][0]["won_percent"], 85.0);
}

TEST(Report, JsonHasTheAgreedKeysAndNoNan) {
  const auto json = nlohmann::json::parse(two_rows().json());
  EXPECT_EQ(json["name"], "registration");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["profile"], "gauss");
  EXPECT_EQ(json["git"], built_from());
  ASSERT_EQ(json["rows"].size(), 2u);
  const nlohmann::json expected{{"case", "pair"}, {"metric", "position_mm"}, {"value", 5.0},
                                {"unit", "mm"},   {"baseline", "icp"},       {"ratio", 0.25}};
  EXPECT_EQ(json["rows"][0], expected);
  EXPECT_TRUE(json["rows"][1]["value"].is_null());
  EXPECT_TRUE(json["rows"][1]["ratio"].is_null());
}

TEST(Report, ABrokenConditionIsRememberedAndSaid) {
  Report report = two_rows();
  report.condition("fine", true);
  EXPECT_TRUE(report.all_conditions_hold());
  report.condition("not fine", false);
  EXPECT_FALSE(report.all_conditions_hold());
  EXPECT_THAT(report.json(), HasSubstr("BROKEN: not fine"));
}

TEST(Percentile, InterpolatesAndCountsFailuresAsTheWorst) {
  EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2);
  EXPECT_DOUBLE_EQ(median({1, 2}), 1.5);
  EXPECT_DOUBLE_EQ(percentile({0, 10}, 0.95), 9.5);
  EXPECT_DOUBLE_EQ(median({1, 2, kNan}), 2);
  EXPECT_TRUE(std::isinf(worst({1, 2, kNan})));
  EXPECT_TRUE(std::isinf(median({1, kNan, kNan})));
  EXPECT_TRUE(std::isnan(median({})));
}

}  // namespace
}  // namespace chorus::bench
