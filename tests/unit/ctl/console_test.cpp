#include "services/ctl/line/console.h"

#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "common/client/service_client.h"
#include "services/ctl/operate/registration_report.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Table, AlignsColumnsToTheirWidestCell) {
  EXPECT_EQ(table({{"sensor", "x"}, {"s1", "1.0"}, {"longer-one", "2"}}),
            "sensor      x\n"
            "s1          1.0\n"
            "longer-one  2\n");
  EXPECT_EQ(table({}), "");
}

TEST(Printable, HasNoControlCharactersAndKeepsTheRest) {
  EXPECT_EQ(printable("sensor s\xC3\xA4 \xE2\x80\xA6 1"), "sensor s\xC3\xA4 \xE2\x80\xA6 1");
  EXPECT_EQ(printable("\x1b[31m\a\n\x7f\xC2\x9b"
                      "0m"),
            "?[31m????0m");
  EXPECT_EQ(printable(std::string_view("\0\xC2", 2)), "?\xC2");
  EXPECT_EQ(printable("good\xE2\x80\xAE"
                      "dab\xE2\x81\xA9 \xE2\x80"),
            "good?dab? \xE2\x80")
      << "an override of the direction of text, and an unfinished character";
  EXPECT_EQ(table({{"a\x1b[2J", "b\n"}}), "a?[2J  b?\n");
}

TEST(LinesAt, AreTheStringsOfAnArrayOnly) {
  const auto json = nlohmann::json::parse(R"({"a": ["x", 3, "y\u001b"], "b": "z"})");
  EXPECT_EQ(lines_at(json, "a"), (std::vector<std::string>{"x", "y?"}));
  EXPECT_TRUE(lines_at(json, "b").empty());
  EXPECT_TRUE(lines_at(json, "c").empty());
  EXPECT_TRUE(lines_at(nlohmann::json(), "a").empty());
}

TEST(Shown, HasDigitsOrADash) {
  EXPECT_EQ(shown(1.005, 1), "1.0");
  EXPECT_EQ(shown(-0.0004, 3), "0.000");
  EXPECT_EQ(shown(-0.0006, 3), "-0.001");
  EXPECT_EQ(shown(-0.2, 0), "0");
  EXPECT_EQ(shown(std::nan(""), 3), "-");
  EXPECT_EQ(shown(-INFINITY, 3), "-");
}

TEST(Progress, PrintsOneLineATenthWhereThereIsNoTerminal) {
  std::ostringstream out;
  Progress progress(out, false, "walk");
  for (int i = 0; i <= 100; ++i) progress.show(i / 100.0, "None");
  progress.show(1.0, "Good");
  progress.finish();
  const std::string text = out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 12);
  EXPECT_THAT(text, HasSubstr("walk: 50% None\n"));
  EXPECT_THAT(text, HasSubstr("walk: 100% Good\n"));
  EXPECT_THAT(text, Not(HasSubstr("\r")));
}

TEST(Progress, RedrawsABarOnATerminalAndSurvivesNonsense) {
  std::ostringstream out;
  Progress progress(out, true, "walk");
  progress.show(0.5, "None");
  progress.show(std::nan(""), "None");
  progress.show(7.0, "Good");
  progress.finish();
  EXPECT_THAT(out.str(), HasSubstr("\rwalk [###############...............]  50% None"));
  EXPECT_THAT(out.str(), HasSubstr("100% Good"));
  EXPECT_EQ(out.str().back(), '\n');
}

TEST(RegistrationReport, ShowsVerdictReasonsAndPlaces) {
  const auto registration = nlohmann::json::parse(R"({
    "verdict": "Provisional", "reasons": ["the walk lasted only 2 s"], "master": "s1",
    "sensors": {"s1": {"x": 0, "y": 1.2, "z": 0, "qx": 0, "qy": 0.70711, "qz": 0, "qw": 0.70711,
                       "error": 0.0123, "chain": ["s1"]},
                "s2": {"x": "far", "chain": ["s1", "s2"]}}})");
  const std::string report = registration_report(registration);
  EXPECT_THAT(report, HasSubstr("registration: Provisional, master s1\n"));
  EXPECT_THAT(report, HasSubstr("  the walk lasted only 2 s\n"));
  EXPECT_THAT(report, HasSubstr("90.0"));
  EXPECT_THAT(report, HasSubstr("12.3"));
  EXPECT_THAT(report, HasSubstr("s1 > s2"));
}

TEST(RegistrationReport, TakesAnyJson) {
  for (const char* text : {"null", "[]", "3", "{}", R"({"sensors": 3, "reasons": {"a": 1}})",
                           R"({"verdict": 7, "sensors": {"s1": null}})"})
    EXPECT_THAT(registration_report(nlohmann::json::parse(text)), HasSubstr("registration: None"));
}

TEST(JsonAccess, FallsBackWhereTheTypeIsAnother) {
  const auto json = nlohmann::json::parse(R"({"a": 1, "b": "x", "c": {"d": 2}})");
  EXPECT_EQ(client::text_at(json, "a"), "-");
  EXPECT_EQ(client::text_at(json, "b"), "x");
  EXPECT_TRUE(std::isnan(client::number_at(json, "b")));
  EXPECT_EQ(client::number_at(client::part_at(json, "c"), "d"), 2.0);
  EXPECT_TRUE(client::part_at(json, "a").empty());
  EXPECT_TRUE(client::part_at(nlohmann::json(), "a").empty());
}

}  // namespace
}  // namespace chorus::ctl
