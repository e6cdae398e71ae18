#include "common/report/report_files.h"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace chorus::report {
namespace {

Report two_figures() {
  Report report{"comparison", "A and B"};
  Section section{"joints", "Joints"};
  section.figures = {{"head", "head, \"top\"", 1.5, "mm"},
                     {"foot", "foot", NAN, "mm", "never seen"}};
  section.plots = {{"drift", {"s"}, {"mm"}, {{"all", Mark::Line, {0, 1}, {NAN, 2}}}}};
  report.sections = {section};
  return report;
}

TEST(ReportForPrograms, IsJsonWithNullsForWhatIsNotFinite) {
  const auto json = nlohmann::json::parse(json_of(two_figures()));
  const auto& section = json.at("sections").at(0);
  EXPECT_EQ(section.at("figures").at(0).at("value"), 1.5);
  EXPECT_TRUE(section.at("figures").at(1).at("value").is_null());
  EXPECT_EQ(section.at("figures").at(1).at("text"), "never seen");
  EXPECT_TRUE(section.at("series").at(0).at("y").at(0).is_null());
}

TEST(ReportForPrograms, IsCsvWithQuotedFields) {
  EXPECT_EQ(csv_of(two_figures()),
            "section,key,name,value,unit,judgement,limit,text\r\n"
            "joints,head,\"head, \"\"top\"\"\",1.5,mm,,,\r\n"
            "joints,foot,foot,,mm,,,never seen\r\n");
}

TEST(ReportForPrograms, RefusesAnUnknownEnding) {
  const auto written = write_report(two_figures(), "report.pdf");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace chorus::report
