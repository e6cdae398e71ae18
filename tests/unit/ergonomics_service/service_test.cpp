#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/base/units.h"
#include "common/ergonomics/all_methods.h"
#include "services/ergonomics/ergonomics_host.h"
#include "services/ergonomics/score_nodes.h"
#include "tests/support/builders.h"
#include "tests/support/served.h"

namespace chorus::ergonomics_service {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using nlohmann::json;
using ::testing::HasSubstr;
using enum JointId;

/// Person 3 stands; from frame 90 on they bend by 45 degrees.
resource::FrameResource frame(int i) {
  resource::FrameResource out;
  out.sequence = static_cast<std::uint64_t>(i + 1);
  out.captured = kStart + i * kFrameInterval;
  out.space = resource::SpaceKind::World;
  auto& body = out.bodies.emplace_back();
  body.id = 3;
  auto person = chorus::testing::standing_person();
  if (i >= 90) {
    const Eigen::Vector3d hips = 0.5 * (person[HipLeft].position + person[HipRight].position);
    for (const JointId id :
         {ShoulderLeft, ShoulderRight, SpineShoulder, Head, ElbowLeft, ElbowRight})
      person[id].position = hips + Eigen::AngleAxisd(deg(45), Eigen::Vector3d::UnitX()) *
                                       (person[id].position - hips);
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    static_cast<Joint&>(body.joints[j]) = person.joints[j];
    body.joints[j].variance = 1e-4;
  }
  return out;
}

Scoring scoring() {
  return {{&ergonomics::kReba, &ergonomics::kOwas}, ergonomics::shipped_rules()};
}

TEST(ScoresOfATracker, ComeWithTheirDoubtForEverybody) {
  Scoring scores = scoring();
  for (int i = 0; i < 150; ++i) scores.take(frame(i));
  const ScoreFrame& latest = scores.latest();
  ASSERT_EQ(latest.persons.size(), 1u);
  const PersonScores& person = latest.persons[0];
  EXPECT_EQ(person.person, 3u);
  ASSERT_TRUE(person.scores[1].known());
  EXPECT_EQ(person.scores[1].score.low, 2) << "OWAS of a bent back";
  EXPECT_GT(person.scores[1].score.high, 2) << "the load is unknown";
  ASSERT_FALSE(person.postures.empty());
  EXPECT_EQ(person.postures[0].name, "bent");
  EXPECT_EQ(person.stance, Stance::Missing);
}

TEST(ScoresOfATracker, ReachBackThirtySeconds) {
  Scoring scores = scoring();
  for (int i = 0; i < 1200; i += 3) scores.take(frame(i));
  EXPECT_EQ(scores.at(kStart), nullptr);
  EXPECT_EQ(scores.at(kStart + std::chrono::minutes(5)), nullptr);
  const auto* then = scores.at(kStart + std::chrono::seconds(30));
  ASSERT_NE(then, nullptr);
  EXPECT_EQ(then->sequence, 901u);
  scores.take(frame(4));
  EXPECT_EQ(scores.latest().sequence, 1198u) << "an old frame changes nothing";
}

TEST(Stances, AreSeenOnRequestOrSayWhyNot) {
  Scoring scores = scoring();
  EXPECT_FALSE(scores.ask_stance(3));
  for (int i = 0; i < 10; ++i) scores.take(frame(i));
  ASSERT_TRUE(scores.ask_stance(3));
  for (int i = 10; i < 40; ++i) scores.take(frame(i));
  EXPECT_EQ(scores.latest().persons[0].stance, Stance::Asked);
  for (int i = 40; i < 80; ++i) scores.take(frame(i));
  EXPECT_EQ(scores.latest().persons[0].stance, Stance::Known);
  for (int i = 80; i < 100; ++i) scores.take(frame(i));
  ASSERT_TRUE(scores.ask_stance(3));
  for (int i = 100; i < 170; ++i) scores.take(frame(i));
  EXPECT_EQ(scores.latest().persons[0].stance, Stance::Missing);
  EXPECT_THAT(scores.latest().persons[0].stance_trouble, HasSubstr("the trunk is bent"));
}

class Served : public ::testing::Test {
 protected:
  void SetUp() override {
    service.add_routes(router);
    for (int i = 0; i < 60; ++i) service.take(frame(i));
  }
  Result<http::ActionResult> act(http::Method method, const std::string& path,
                                 std::string_view body) {
    const auto match = router.match(path);
    http::Request request;
    request.method = method;
    request.path = path;
    request.body = body;
    return match->entry->actions.at(method)(request, match->params);
  }
  /// The status of `path` with ?at=.
  int status_at(const std::string& path, const std::string& at) {
    const auto match = router.match(path);
    http::Request request;
    request.path = path;
    request.query["at"] = at;
    const auto document = match->entry->getter(request, match->params);
    return document ? 200 : http_status(document.error().code);
  }
  ErgonomicsService service{scoring(), {"run1"}};
  http::Router router;
};

TEST_F(Served, EverybodyAndEachPersonInEveryFormat) {
  const auto all = chorus::testing::get(router, "/ergonomics/");
  ASSERT_EQ(all.status, 200) << all.body;
  const json scores = json::parse(all.body);
  EXPECT_EQ(scores["sequence"], 60);
  EXPECT_EQ(scores["persons"][0]["bodyId"], 3);
  const auto one = json::parse(chorus::testing::get(router, "/ergonomics/3").body);
  EXPECT_EQ(one["scores"][0]["method"], "reba");
  EXPECT_LE(one["scores"][0]["scoreLow"].get<int>(), one["scores"][0]["scoreHigh"].get<int>());
  for (const char* type : {"text/turtle", "application/ld+json", "application/n-triples"}) {
    const auto answer = chorus::testing::get(router, "/ergonomics/", type);
    EXPECT_EQ(answer.status, 200);
    EXPECT_THAT(answer.body, HasSubstr("scoreHigh")) << type;
  }
  EXPECT_EQ(chorus::testing::get(router, "/ergonomics/4").status, 404);
  EXPECT_EQ(chorus::testing::get(router, "/ergonomics/eve").status, 404);
  EXPECT_EQ(status_at("/ergonomics/3", "yesterday"), 400);
  EXPECT_EQ(status_at("/ergonomics/3", to_iso8601(kStart + 30 * kFrameInterval)), 200);
  EXPECT_EQ(status_at("/ergonomics/3", to_iso8601(kStart - std::chrono::hours(1))), 404);
  EXPECT_THAT(chorus::testing::get(router, "/methods/").body, HasSubstr("Hignett"));
}

TEST_F(Served, UseOnlyDeclaredTerms) {
  Scoring scores = scoring();
  for (int i = 0; i < 150; ++i) scores.take(frame(i));
  auto latest = scores.latest();
  latest.persons[0].stance_trouble = "none";
  EXPECT_EQ(resource::undeclared_terms(scores_node(latest, scores.methods())),
            std::vector<std::string>{});
  latest.persons[0].reason = ergonomics::Unscored::Carried;
  EXPECT_EQ(resource::undeclared_terms(person_node(latest.persons[0], scores.methods(), "")),
            std::vector<std::string>{});
  EXPECT_EQ(resource::undeclared_terms(methods_node(scores.methods())), std::vector<std::string>{});
  EXPECT_EQ(resource::undeclared_terms(service::self_node(service.description())),
            std::vector<std::string>{});
}

TEST_F(Served, AnswersNarrowTheRangeAndAreChecked) {
  const auto range = [&] {
    const json reba = json::parse(chorus::testing::get(router, "/ergonomics/3").body)["scores"][0];
    return reba["scoreHigh"].get<int>() - reba["scoreLow"].get<int>();
  };
  const int before = range();
  const auto put = act(
      http::Method::Put, "/asked",
      R"({"loadKg": 3, "shock": false, "coupling": "good", "wrist": "straight", "wristTwisted": false,
      "armSupported": false, "heldOverMinute": false, "repeated": false, "unstable": false})");
  ASSERT_TRUE(put) << to_string(put.error());
  service.take(frame(60));
  EXPECT_GT(before, 0);
  EXPECT_EQ(range(), 0);
  EXPECT_THAT(act(http::Method::Put, "/asked", R"({"loadKg": 981})").error().message,
              HasSubstr("newtons"));
  EXPECT_FALSE(act(http::Method::Put, "/asked", R"({"load": 1})"));
  EXPECT_FALSE(act(http::Method::Put, "/asked", "[]"));
  EXPECT_EQ(act(http::Method::Post, "/ergonomics/3/stance", "")->status, 202);
  EXPECT_FALSE(act(http::Method::Post, "/ergonomics/9/stance", ""));
}

TEST(Settings, ShippedFileHoldsEveryDefault) {
  const auto text = read_file("deploy/config/ergonomics.json", 1'000'000);
  ASSERT_TRUE(text);
  const auto shipped =
      ConfigReader::parse(*text, "ergonomics.json").and_then(&read_ergonomics_settings);
  ASSERT_TRUE(shipped) << to_string(shipped.error());
  const auto defaults = ConfigReader::parse("{}", "none").and_then(&read_ergonomics_settings);
  ASSERT_TRUE(defaults);
  EXPECT_TRUE(*shipped == *defaults);
  const auto wrong =
      ConfigReader::parse(R"({"methods": "rebba"})", "c").and_then(&read_ergonomics_settings);
  ASSERT_FALSE(wrong);
  EXPECT_THAT(to_string(wrong.error()), HasSubstr("did you mean reba"));
}

}  // namespace
}  // namespace chorus::ergonomics_service
