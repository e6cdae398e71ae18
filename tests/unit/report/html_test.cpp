#include "common/report/html.h"

#include <cmath>

#include <gmock/gmock.h>

namespace chorus::report {
namespace {

using testing::HasSubstr;
using testing::Not;

Report small_report() {
  Report report{"evaluation", "Inertial evaluation"};
  report.verdict = "usable";
  report.judgement = Judgement::Doubtful;
  report.subject = {{"recording", "walk.mcap"}};
  Section section{"limbs", "Limbs"};
  Figure figure{"forearm_left.off", "left forearm off"};
  figure.value = 14.25;
  figure.unit = "%";
  figure.meaning = "share of time in which tracker and sensor disagree";
  figure.limit = "at most 5 %";
  figure.advice = "add a sensor that sees the left side";
  figure.judgement = Judgement::Bad;
  section.figures = {figure};
  report.sections = {section};
  return report;
}

TEST(HtmlReport, SaysVerdictValueMeaningLimitAndAdvice) {
  const std::string page = html_of(small_report());
  for (const char* text :
       {"usable", "14.25 %", "share of time", "at most 5 %", "add a sensor", "walk.mcap"})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(HtmlReport, GivesAdviceOnlyWhenAFigureIsBad) {
  Report report = small_report();
  report.sections[0].figures[0].judgement = Judgement::Good;
  EXPECT_THAT(html_of(report), Not(HasSubstr("add a sensor")));
}

TEST(HtmlReport, ExecutesNoMarkupAndAsksNobody) {
  Report report = small_report();
  const std::string attack = "<script>alert(1)</script>\"'&";
  report.title = attack;
  report.subject = {{attack, attack}};
  report.sections[0].title = attack;
  report.sections[0].paragraphs = {attack};
  report.sections[0].figures[0].name = attack;
  report.sections[0].tables = {{attack, {attack}, {{attack}}}};
  report.sections[0].plots = {{attack, {attack}, {attack}, {{attack, Mark::Line, {0, 1}, {0, 1}}}}};
  report.sections[0].pictures = {{attack, "image/png", "x", attack}};
  const std::string page = html_of(report);
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
}

TEST(HtmlReport, SpeaksGerman) {
  Report report = small_report();
  report.language = "de";
  EXPECT_THAT(html_of(report), HasSubstr("Bedeutung"));
  EXPECT_THAT(html_of(report), HasSubstr("lang=\"de\""));
}

TEST(HtmlReport, EmbedsPicturesWithPadding) {
  Report report = small_report();
  report.sections[0].pictures = {{"one", "image/png", "a", "one"},
                                 {"four", "image/png", "abcd", "four"}};
  const std::string page = html_of(report);
  EXPECT_THAT(page, HasSubstr("base64,YQ==\""));
  EXPECT_THAT(page, HasSubstr("base64,YWJjZA==\""));
}

TEST(ReadableNumbers, KeepFourDigitsAndNoExponent) {
  EXPECT_EQ(readable(0.0), "0");
  EXPECT_EQ(readable(-0.00001), "-1e-05");
  EXPECT_EQ(readable(0.12345), "0.123");
  EXPECT_EQ(readable(12.3456), "12.35");
  EXPECT_EQ(readable(1500.0), "1500");
  EXPECT_EQ(readable(123456.7), "123457");
  EXPECT_EQ(readable(NAN), "-");
}

}  // namespace
}  // namespace chorus::report
