#include "common/report/plot.h"

#include <cmath>

#include <gmock/gmock.h>

namespace chorus::report {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Plot one_line(const std::string& title) {
  return {title,
          {"time [s]"},
          {"angle [deg]"},
          {{"left forearm", Mark::Line, {0, 1, 2}, {10, 60, 20}}}};
}

TEST(Plots, AreDrawnAsOneDocumentEach) {
  Plot limits = one_line("second");
  limits.spans = {{0.5, 1.5}};
  limits.levels = {{45.0, "tau"}};
  limits.series[0].low = {5, 50, 10};
  limits.series[0].high = {15, 70, 30};
  const auto documents = drawn({one_line("first"), limits});
  ASSERT_TRUE(documents) << documents.error().message;
  ASSERT_EQ(documents->size(), 2U);
  EXPECT_THAT((*documents)[0], StartsWith("<svg"));
  EXPECT_THAT((*documents)[0], HasSubstr("first"));
  EXPECT_THAT((*documents)[0], Not(HasSubstr("second")));
  EXPECT_THAT((*documents)[1], HasSubstr("tau"));
}

TEST(Plots, WithoutSeriesOrFinitePointsAreStillDrawn) {
  Plot nothing{"nothing", {"x"}, {"y"}};
  Plot gaps = one_line("gaps");
  gaps.series[0].y = {NAN, INFINITY, NAN};
  gaps.y.least = 0.0;
  gaps.y.most = 1.0;
  Plot empty = one_line("empty");
  empty.series[0] = {"none"};
  for (const Plot& plot : {gaps, one_line("after"), nothing, empty}) {
    const auto documents = drawn({plot, one_line("control")});
    EXPECT_TRUE(documents) << plot.title;
  }
}

TEST(Plots, ExecuteNothingThatStandsInATitle) {
  const std::string script = gnuplot_script({one_line("`touch x` '; system('touch y') #\nquit")});
  EXPECT_THAT(script, HasSubstr("set title '`touch x` ''; system(''touch y'') # quit'\n"));
}

TEST(Plots, PutBarsOfTwoSeriesSideBySide) {
  Plot plot{"bars", {"limb"}, {"deg"}};
  plot.x.categories = {"arm", "leg"};
  plot.series = {{"ours", Mark::Bars, {0, 1}, {5, 6}}, {"paper", Mark::Bars, {0, 1}, {15, 16}}};
  const std::string script = gnuplot_script({plot});
  EXPECT_THAT(script, HasSubstr("($1+-0.2):2"));
  EXPECT_THAT(script, HasSubstr("($1+0.2):2"));
  EXPECT_TRUE(drawn({plot}));
}

}  // namespace
}  // namespace chorus::report
