#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/assessment/people.h"
#include "common/assessment/score_documents.h"
#include "common/assessment/sheet.h"
#include "common/base/units.h"
#include "tests/support/builders.h"

namespace chorus::assessment {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using enum JointId;

/// Stands for three seconds, then bends to a box on the floor for three.
People recording() {
  People people;
  for (int i = 0; i < 180; ++i) {
    resource::FrameResource frame;
    frame.captured = kStart + i * kFrameInterval;
    frame.space = resource::SpaceKind::World;
    auto& body = frame.bodies.emplace_back();
    body.id = 7;
    auto person = chorus::testing::standing_person();
    if (i >= 90) {
      const Eigen::Vector3d hips = 0.5 * (person[HipLeft].position + person[HipRight].position);
      for (const JointId id : {SpineMid, Neck, Head, SpineShoulder, ShoulderLeft, ShoulderRight,
                               ElbowLeft, ElbowRight, WristLeft, WristRight})
        person[id].position = hips + Eigen::AngleAxisd(deg(70), Eigen::Vector3d::UnitX()) *
                                         (person[id].position - hips);
    }
    for (std::size_t j = 0; j < kJointCount; ++j) {
      static_cast<Joint&>(body.joints[j]) = person.joints[j];
      body.joints[j].variance = 1e-4;
    }
    if (i == 170) body.carried_for = 0.1;
    EXPECT_TRUE(people.add(frame));
  }
  return people;
}

Assessment assessed(const People& people, std::string_view task) {
  Assessment about;
  about.source = "<take>.mcap";
  about.start = people.start();
  about.seconds = people.seconds();
  about.methods = *ergonomics::find_methods("reba,owas,eaws-like");
  about.task = ergonomics::read_task(task, "task").value();
  const auto& bodies = people.bodies().at(7);
  auto stance = stance_of(bodies, about.task.stance, about.start);
  EXPECT_TRUE(stance);
  about.persons.push_back(assess({7, bodies, *stance}, about, ergonomics::shipped_rules()));
  return about;
}

constexpr std::string_view kTask =
    R"({"title": "Boxes", "loadKg": 4, "shock": false, "coupling": "good", "wrist": "straight",
  "wristTwisted": false, "armSupported": false, "heldOverMinute": false, "repeated": false, "unstable": false, "cycleSeconds": 3,
  "phases": [{"name": "bend", "fromSeconds": 3, "toSeconds": 5.9, "loadKg": 12}],
  "lifts": [{"fromSeconds": 4, "toSeconds": 1, "loadKg": 12, "perMinute": 1, "hours": 1, "coupling": "fair"}],
  "eawsPoints": {"secondsPerMinute": [3, 20, 40], "points": {"standing": [1, 2, 3], "strongly bent": [10, 20, 30]}}})";

TEST(ScoreDocuments, SumUpARecording) {
  std::string task(kTask);
  task.replace(task.find("\"fromSeconds\": 4, \"toSeconds\": 1"), 32,
               "\"fromSeconds\": 1, \"toSeconds\": 4");
  const auto people = recording();
  const auto about = assessed(people, task);
  const json all = json::parse(summary_json(about));
  const json& person = all["persons"][0];
  EXPECT_EQ(person["person"], 7);
  EXPECT_TRUE(person["ownStance"]);
  EXPECT_NEAR(person["cycles"].get<double>(), 1.99, 0.02);
  const json& reba = person["methods"]["reba"];
  EXPECT_GT(reba["p90"].get<int>(), reba["p50"].get<int>() - 1);
  EXPECT_NEAR(reba["unscored"]["carried"].get<double>(), 1.0 / 180, 1e-3);
  EXPECT_GT(reba["worst"][0]["atSeconds"].get<double>(), 3.0);
  const json& bend = person["phases"][0]["methods"]["reba"];
  EXPECT_GT(bend["p90"].get<int>(), reba["p50"].get<int>());
  // Half of the time upright (30 s a minute: 2 points), half strongly bent (20 points).
  EXPECT_EQ(person["methods"]["eaws-like"]["points"].get<double>(), 22.0);
  EXPECT_EQ(person["lifts"].size(), 1u);
  const json& lift = person["lifts"][0];
  EXPECT_GT(lift["origin"]["limitKg"].get<double>(), 5.0);
  EXPECT_EQ(lift["destination"]["limitKg"], 0.0)
      << "the hands are farther than 63 cm from the ankles";
  EXPECT_TRUE(lift["liftingIndex"].is_null());
  EXPECT_EQ(person["events"][0]["posture"], "standing");
  EXPECT_EQ(person["events"][1]["posture"], "strongly-bent");
}

TEST(ScoreDocuments, CsvHasALineForEachInstantAndMethod) {
  const auto people = recording();
  const auto about = assessed(people, "{}");
  const std::string csv = scores_csv(about);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 180 * 3);
  EXPECT_THAT(csv, HasSubstr("5.667,7,reba,,,,,,,,,carried\n"));
  const std::string angles = measures_csv(about);
  EXPECT_EQ(std::ranges::count(angles, '\n'), 1 + 180);
  EXPECT_THAT(angles, HasSubstr("trunkFlexion_deg"));
}

TEST(Sheets, MarkMeasuredAskedAndUnknownFields) {
  const auto people = recording();
  const auto about = assessed(people, R"({"loadKg": 4})");
  const auto html =
      sheet_html(about, {{about.persons[0], people.bodies().at(7)}}, Language::English);
  EXPECT_THAT(html, HasSubstr("<td class=\"measured\">Trunk</td>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"asked\">Load</td>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"unknown\">Coupling</td>"));
  EXPECT_THAT(html, HasSubstr("if the grip is good"));
  EXPECT_THAT(html, HasSubstr("&lt;take&gt;.mcap"));
  EXPECT_THAT(html, HasSubstr("<svg"));
  EXPECT_THAT(html, Not(HasSubstr("http://")));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST(Sheets, AreGermanOnRequest) {
  const auto people = recording();
  const auto about = assessed(people, "{}");
  const auto html =
      sheet_html(about, {{about.persons[0], people.bodies().at(7)}}, Language::German);
  EXPECT_THAT(html, HasSubstr("lang=\"de\""));
  EXPECT_THAT(html, HasSubstr("keine zertifizierte Bewertung"));
  EXPECT_THAT(html, Not(HasSubstr("measured</td>")));
}

TEST(Stances, ThatATaskNamesMustBeSome) {
  const auto people = recording();
  const auto& bodies = people.bodies().at(7);
  EXPECT_TRUE(stance_of(bodies, ergonomics::Span{0.5, 2.5}, people.start()));
  const auto bent = stance_of(bodies, ergonomics::Span{4.0, 5.5}, people.start());
  ASSERT_FALSE(bent);
  EXPECT_THAT(to_string(bent.error()), HasSubstr("the trunk is bent"));
}

TEST(People, RefuseFramesThatGoBack) {
  People people;
  resource::FrameResource frame;
  frame.captured = kStart + kFrameInterval;
  EXPECT_TRUE(people.add(frame));
  EXPECT_TRUE(people.add(frame)) << "twice counts once";
  EXPECT_EQ(people.frames(), 1u);
  frame.captured = kStart;
  EXPECT_FALSE(people.add(frame));
}

}  // namespace
}  // namespace chorus::assessment
