#include <cmath>

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
    sensor.compared = 1000;
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

SensorQuality& sensor(RecordingQuality& quality, const char* id) {
  return quality.sensors[testing::sensor_id(id)];
}

TEST(Findings, NameTheFaultyPart) {
  RecordingQuality quality = healthy();
  quality.fused.joints[6].missing = 0.14;
  EXPECT_THAT(what(quality), ElementsAre("WristLeft is missing in 14 %"));
  quality = healthy();
  sensor(quality, "s1").residual = 0.2;
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s1 disagrees with the others")));
  quality = healthy();
  sensor(quality, "s1").rate = 9.0;
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s1 delivers 9.0 frames/s, the others 30.0")));
  quality = healthy();
  sensor(quality, "s2").lateness = 0.4;
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s2 is late")));
  quality = healthy();
  sensor(quality, "s3").repeated = 0.5;
  EXPECT_THAT(what(quality), ElementsAre("s3 says the same again in 50 % of its frames"));
  quality = healthy();
  sensor(quality, "s3").exchanged = 0.9;
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s3 exchanges left and right")));
}

TEST(Findings, OfRecordingsOfDifferentYearsBlameNoLoad) {
  RecordingQuality quality = healthy();
  quality.fused.pauses = 1;
  quality.fused.longest_pause = 4.0;
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("the output paused 1 times")));
  quality.fused.longest_pause = 2.18e8;
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("2523.1 days lie between")));
}

TEST(Findings, OfAFewSecondsSayNothingOfPlacesAndClocks) {
  RecordingQuality quality = healthy();
  sensor(quality, "s1").clock = 0.085;
  sensor(quality, "s2").offset_last = {0.17, 0, 0};
  sensor(quality, "s3").offset_in_sensor = {0.09, 0, 0};
  EXPECT_EQ(what(quality).size(), 3U);
  quality.fused.seconds = 9.9;
  EXPECT_THAT(what(quality), ::testing::IsEmpty());
  EXPECT_THAT(remarks_of(quality), ElementsAre(HasSubstr("too short to tell")));
}

TEST(Findings, BlameTheSensorThatMovedNotThoseThatTheFusedBodyMovedAwayFrom) {
  RecordingQuality quality = healthy();
  sensor(quality, "s1").offset_last = {-0.06, 0.0, 0.0};
  sensor(quality, "s2").offset_last = {0.12, 0.0, 0.0};
  sensor(quality, "s3").offset_last = {-0.06, 0.0, 0.0};
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s2 was moved: its views changed by 180 mm")));
  quality = healthy();
  sensor(quality, "s1").clock = sensor(quality, "s2").clock = 0.04;
  sensor(quality, "s3").clock = -0.08;
  EXPECT_THAT(what(quality), ElementsAre("the clock of s3 is off by -120 ms"));
}

TEST(Findings, OfTwoSensorsNameBoth) {
  RecordingQuality quality = healthy();
  quality.sensors.erase(testing::sensor_id("s3"));
  sensor(quality, "s1").offset_last = {-0.06, 0.0, 0.0};
  sensor(quality, "s2").offset_last = {0.06, 0.0, 0.0};
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s1 or s2 was moved")));
}

TEST(Findings, OfTwoSensorsAreTheSameWhicheverDisagrees) {
  for (const char* id : {"s1", "s2"}) {
    RecordingQuality quality = healthy();
    quality.sensors.erase(testing::sensor_id("s3"));
    sensor(quality, id).residual = 0.2;
    EXPECT_THAT(what(quality), ElementsAre("s1 or s2 disagrees with the other one: 200 mm of " +
                                           std::string(id) + ", usual 30 mm"));
    sensor(quality, id).residual = 0.03;
    for (auto& [name, figures] : quality.sensors) figures.joints.fill(0.03);
    sensor(quality, id).joints[6] = 0.25;
    EXPECT_THAT(what(quality), ElementsAre(HasSubstr("s1 or s2 sees WristLeft 250 mm from")));
    for (auto& [name, figures] : quality.sensors)
      if (name != testing::sensor_id(id)) figures.joints[6] = std::nan("");
    EXPECT_THAT(what(quality), ::testing::IsEmpty()) << "nobody else sees it";
  }
}

TEST(Findings, DoNotCallASensorMovedThatSawNobodyInTheEnd) {
  RecordingQuality quality = healthy();
  for (auto& [id, figures] : quality.sensors)
    figures.offset_first = figures.offset_last = {0.06, 0.0, 0.0};
  sensor(quality, "s2").offset_last.fill(std::nan(""));
  EXPECT_THAT(what(quality), ::testing::IsEmpty());
}

TEST(Findings, WhatAllSensorsDoAlikeIsNobodysFault) {
  RecordingQuality quality = healthy();
  for (auto& [id, figures] : quality.sensors) figures.offset_in_sensor = {0.0, 0.0, -0.12};
  EXPECT_THAT(what(quality), ::testing::IsEmpty()) << "a depth bias is no place";
}

TEST(Findings, NameJointsThatAreLostTogetherOnce) {
  RecordingQuality quality = healthy();
  quality.fused.shares["s1"] = 1.0;
  for (const JointId id : {JointId::WristLeft, JointId::HandLeft})
    quality.fused.joints[index_of(id)].unseen = 0.3;
  EXPECT_THAT(what(quality), ElementsAre("WristLeft, HandLeft are guessed in 30 %"));
  for (auto& joint : quality.fused.joints) joint.unseen = 0.0;
  for (const JointId id : {JointId::ThumbLeft, JointId::ThumbRight})
    quality.fused.joints[index_of(id)].missing = 1.0;
  EXPECT_THAT(what(quality), ::testing::IsEmpty()) << "this model of a body has no thumbs";
  EXPECT_THAT(remarks_of(quality),
              ::testing::Contains("no sensor ever reports ThumbLeft, ThumbRight"));
}

TEST(Findings, SayWhenErrorsAreLargerThanStated) {
  RecordingQuality quality = healthy();
  for (auto& each : quality.views) each = {0.1, 0.02};
  EXPECT_THAT(what(quality), ElementsAre(HasSubstr("errors are 5.0 times as large as stated")));
  for (auto& each : quality.views) each = {0.04, 0.02};
  EXPECT_THAT(what(quality), ::testing::IsEmpty()) << "the views may show a fifth too much";
}

TEST(Findings, SayWhatCannotBeTold) {
  RecordingQuality quality = healthy();
  for (auto& [id, figures] : quality.sensors) figures.compared = 100;
  EXPECT_THAT(remarks_of(quality), ::testing::IsEmpty());
  quality.verdict = "";
  EXPECT_THAT(remarks_of(quality), ElementsAre(HasSubstr("no registration was recorded")));
  quality.verdict = "Good";
  for (auto& [id, figures] : quality.sensors) figures.compared = 0;
  EXPECT_THAT(remarks_of(quality), ElementsAre(HasSubstr("do the recordings share a time")));
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
