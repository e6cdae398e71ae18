#include "tests/bench/report/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace chorus::bench {
namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++found;
  return found;
}

Plot square() {
  Plot plot{"Squares", {"x [m]", 0, 10}, {"y [m]", 0, 100}, {}, false};
  plot.series.push_back({"ours", Mark::Line, {{0, 0}, {5, 25}, {10, 100}}});
  return plot;
}

TEST(Plot, PlacesPointsOnItsAxes) {
  Plot plot = square();
  plot.series.push_back({"stated", Mark::Dots, {{0, 0}, {10, 100}}});
  const std::string svg = svg_of(plot);
  EXPECT_NE(svg.find("d=\"M70.0 385.0L330.0 298.8L590.0 40.0\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("cx=\"70.0\" cy=\"385.0\""), std::string::npos);
  EXPECT_NE(svg.find("cx=\"590.0\" cy=\"40.0\""), std::string::npos);
  for (const char* label : {"Squares", "x [m]", "y [m]", "ours", "stated", ">0<", ">10<", ">100<"})
    EXPECT_NE(svg.find(label), std::string::npos) << label;
}

TEST(Plot, FollowsTheDataWhereAnAxisIsNotGiven) {
  Plot plot;
  plot.series.push_back({"", Mark::Dots, {{100, -3}, {200, -1}}});
  const std::string svg = svg_of(plot);
  EXPECT_EQ(count(svg, "<circle"), 2u) << "both are on the sheet";
  EXPECT_NE(svg.find(">160<"), std::string::npos);
  EXPECT_NE(svg.find(">-2<"), std::string::npos);
}

TEST(Plot, TicksStandWhereTheAxisSays) {
  Plot plot = square();
  plot.x.step = 4.5;
  const std::string svg = svg_of(plot);
  EXPECT_NE(svg.find(">4.5<"), std::string::npos);
  EXPECT_NE(svg.find(">9<"), std::string::npos);
  EXPECT_EQ(svg.find(">10<"), std::string::npos);
}

TEST(Plot, BreaksLinesAtGapsAndKeepsNonsenseOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Plot plot = square();
  plot.series = {{"", Mark::Line, {{1, 1}, {2, 4}, {nan, 9}, {4, 16}, {50, 5}, {5, 25}}},
                 {"", Mark::Crosses, {{nan, 1}, {1, -5}, {3, 9}}}};
  const std::string svg = svg_of(plot);
  EXPECT_EQ(count(svg, "nan"), 0u);
  EXPECT_EQ(count(svg, "inf"), 0u);
  EXPECT_EQ(count(svg, "d=\"M122.0 381.6L174.0 371.2M278.0 329.8M330.0 298.8\""), 1u) << svg;
  EXPECT_EQ(count(svg, "l10 10m0 -10l-10 10"), 1u) << "the one cross on the sheet";
}

TEST(Plot, BarsStandOnTheLowerAxis) {
  Plot plot = square();
  plot.series = {{"ours", Mark::Bars, {{5, 25}, {5, 200}}}};
  const std::string svg = svg_of(plot);
  EXPECT_EQ(count(svg, "x=\"317.0\" y=\"298.8\" width=\"26.0\" height=\"86.2\""), 1u) << svg;
  EXPECT_EQ(count(svg, "<rect"), 3u) << "the sheet, the one bar on it and its legend";
}

TEST(Plot, EmptyAndDegenerateOnesAreStillSheets) {
  for (const Plot& plot : {Plot{}, Plot{"", {}, {}, {{"", Mark::Line, {}}}, true},
                           Plot{"", {}, {}, {{"", Mark::Dots, {{3, 3}, {3, 3}}}}, true}}) {
    const std::string svg = svg_of(plot);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    EXPECT_EQ(count(svg, "nan") + count(svg, "inf"), 0u);
  }
}

TEST(Plot, MapsHaveOneScale) {
  Plot plot;
  plot.same_scale = true;
  plot.series.push_back({"", Mark::Line, {{0, 0}, {1, 0}, {1, 3}}});
  const std::string svg = svg_of(plot);
  const std::size_t at = svg.find("d=\"M") + 4;
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + at, "%lf %lfL%lf %lfL%lf %lf", &x0, &y0, &x1, &y1, &x2, &y2),
            6);
  EXPECT_NEAR((y1 - y2) / (x1 - x0), 3.0, 0.01);
}

TEST(Plot, EscapesForeignText) {
  Plot plot = square();
  plot.title = "a < b & \"c\"";
  plot.series[0].name = "<script>";
  const std::string svg = svg_of(plot);
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_EQ(svg.find("<script>"), std::string::npos);
}

TEST(Plot, SeriesMayShareAColour) {
  Plot plot = square();
  plot.series.push_back({"stated", Mark::Crosses, {{5, 25}}, 0});
  plot.series.push_back({"other", Mark::Dashes, {{0, 0}, {1, 1}}});
  const std::string svg = svg_of(plot);
  EXPECT_EQ(count(svg, "#0072b2"), 4u) << "two series and their legend";
  EXPECT_EQ(count(svg, "#009e73"), 2u) << "the third series has the third colour";
  EXPECT_EQ(count(svg, "stroke-dasharray"), 2u);
}

TEST(Plot, IsWrittenOrSaysWhyNot) {
  const std::string folder = ::testing::TempDir();
  ASSERT_TRUE(write_svg(square(), folder, "plot_test_squares").has_value());
  EXPECT_TRUE(std::filesystem::exists(folder + "/plot_test_squares.svg"));
  std::filesystem::remove(folder + "/plot_test_squares.svg");
  EXPECT_FALSE(write_svg(square(), folder + "/no/such/folder", "x").has_value());
}

}  // namespace
}  // namespace chorus::bench
