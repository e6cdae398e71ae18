#include <gmock/gmock.h>

#include "common/quality/quality_report.h"
#include "common/report/html.h"
#include "tests/support/builders.h"

namespace chorus::quality {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

RecordingQuality healthy() {
  RecordingQuality quality;
  quality.name = "walk.mcap";
  quality.verdict = "Good";
  quality.fused.frames = 900;
  quality.fused.seconds = 30.0;
  quality.fused.rate = 30.0;
  quality.fused.people = {PersonQuality{1, 0.0, 30.0, 30.0}};
  for (auto& joint : quality.fused.joints) joint.tracked = 1.0;
  for (const char* id : {"s1", "s2", "s3"}) {
    SensorQuality sensor;
    sensor.rate = 30.0;
    sensor.residual = 0.03;
    quality.sensors[testing::sensor_id(id)] = sensor;
  }
  return quality;
}

std::vector<std::string> what(const RecordingQuality& quality) {
  std::vector<std::string> out;
  for (const Finding& finding : findings_of(quality)) out.push_back(finding.what);
  return out;
}

TEST(Findings, OfAHealthyRecordingAreNone) {
  EXPECT_TRUE(findings_of(healthy()).empty());
  EXPECT_EQ(report_of(healthy()).judgement, report::Judgement::Good);
}

TEST(Findings, NameTheFaultyPart) {
  RecordingQuality quality = healthy();
  quality.sensors[testing::sensor_id("s2")].offset_last = {0.08, 0.0, 0.0};
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s2 was moved")));
  quality = healthy();
  quality.sensors[testing::sensor_id("s3")].clock = -0.12;
  EXPECT_THAT(what(quality), ElementsAre("the clock of s3 is off by -120 ms"));
  quality = healthy();
  quality.fused.joints[6].missing = 0.14;
  EXPECT_THAT(what(quality), ElementsAre("WristLeft is missing in 14 %"));
  quality = healthy();
  quality.sensors[testing::sensor_id("s1")].residual = 0.2;
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s1 disagrees with the others")));
  quality = healthy();
  quality.sensors[testing::sensor_id("s1")].rate = 9.0;
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s1 delivers 9.0 frames/s, the others 30.0")));
}

TEST(Findings, PutTheWorstFirstAndIntoTheVerdict) {
  RecordingQuality quality = healthy();
  quality.fused.joints[6].missing = 0.1;
  quality.fused.turned = {{3.0, 1, "left and right were exchanged"}};
  const auto report = report_of(quality);
  EXPECT_EQ(report.judgement, report::Judgement::Bad);
  EXPECT_THAT(report.verdict, HasSubstr("not usable as it is: left and right were exchanged"));
  EXPECT_THAT(report::html_of(report), HasSubstr("add a sensor that sees people from the front"));
}

TEST(Findings, OfAnEmptyRecordingSayWhatToDo) {
  EXPECT_THAT(findings_of({}).at(0).advice, HasSubstr("chorus fuse"));
}

}  // namespace
}  // namespace chorus::quality
