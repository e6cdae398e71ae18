// The evaluation as resources, and its settings.
#include "services/evaluation/evaluation_service.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/base/units.h"
#include "common/resource/inertial_calibration_resource.h"
#include "services/evaluation/evaluation_host.h"
#include "tests/support/served.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/evaluation_service/walked_suit.h"

namespace chorus::evaluation_service {
namespace {

using chorus::testing::get;
using inertial::Limb;
using nlohmann::json;
using ::testing::HasSubstr;

Heard frame_at(const testing::WalkedSuit& suit, double t) {
  auto document = std::make_shared<resource::FrameResource>();
  document->sequence = static_cast<std::uint64_t>(30 * t) + 1;
  document->captured = testing::kStart + from_seconds(t);
  document->source = "fusion";
  document->space = resource::SpaceKind::World;
  auto& body = document->bodies.emplace_back();
  body.id = 7;
  const auto person = suit.body(t);
  for (std::size_t j = 0; j < kJointCount; ++j)
    static_cast<Joint&>(body.joints[j]) = person.joints[j];
  Frame frame;
  frame.source = testing::sensor_id("tracker");
  frame.document = std::move(document);
  return frame;
}

Heard orientations_at(const testing::WalkedSuit& suit, double t) {
  auto document = std::make_shared<resource::OrientationsResource>();
  document->source = "suit";
  document->captured = testing::kStart + from_seconds(t);
  document->instants = {suit.instant(t)};
  Orientations heard;
  heard.source = testing::sensor_id("suit");
  heard.document = std::move(document);
  return heard;
}

JudgeOptions calibrated() {
  testing::WalkedSuit suit;
  LiveJudge judge;
  testing::walk(judge, suit, 0.0, 7.0);
  JudgeOptions options;
  options.calibrations.push_back(judge.calibration(testing::sensor_id("suit")).value());
  return options;
}

/// A suit that is calibrated and has slipped a second ago.
class ServedEvaluation : public ::testing::Test {
 protected:
  void SetUp() override {
    suit.slip = [](double) { return deg(70); };
    service.judges("http://127.0.0.1:8080/");
    service.add_routes(router);
    for (int i = 0; i < 32; ++i) {
      const double t = 10.0 + i / 30.0;
      service.take(
          {orientations_at(suit, t - 0.005), orientations_at(suit, t + 0.005), frame_at(suit, t)});
    }
  }
  testing::WalkedSuit suit;
  EvaluationService service{calibrated(), {"run1"}, "Test"};
  http::Router router;
};

TEST_F(ServedEvaluation, TellsOfEachLimbInEveryFormat) {
  const auto answer = get(router, "/evaluation");
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json told = json::parse(answer.body);
  EXPECT_EQ(told["tracker"], "http://127.0.0.1:8080/");
  ASSERT_EQ(told["limbs"].size(), 3u) << answer.body;
  const json& forearm = *std::ranges::find_if(
      told["limbs"], [](const json& limb) { return limb["limb"] == "ForearmLeft"; });
  EXPECT_EQ(forearm["state"], "off");
  EXPECT_EQ(forearm["comment"], "left forearm off by 70 deg for 1 s");
  EXPECT_EQ(forearm["bodyId"], 7);
  EXPECT_EQ(forearm["errorSegments"], 1);
  EXPECT_NEAR(forearm["swingDegrees"].get<double>(), 70.0, 3.0);
  EXPECT_FALSE(forearm.contains("twistDegrees")) << "joints do not show it";
  for (const char* type : {"text/turtle", "application/ld+json", "application/n-triples"})
    EXPECT_THAT(get(router, "/evaluation", type).body, HasSubstr("off by 70 deg")) << type;
  EXPECT_EQ(get(router, "/evaluations/1").status, 200);
  EXPECT_THAT(get(router, "/").body, HasSubstr("evaluation/segments"));
}

Eigen::Quaterniond quaternion_in(const json& limb, const std::string& prefix,
                                 const std::string& first) {
  const auto part = [&](const char* axis) { return limb.at(prefix + first + axis).get<double>(); };
  return {part("w"), part("x"), part("y"), part("z")};
}

TEST_F(ServedEvaluation, TellsHowBothHaveTheLimbTurned) {
  const json told = json::parse(get(router, "/evaluation").body);
  for (const json& limb : told["limbs"]) {
    const Eigen::Quaterniond tracked = quaternion_in(limb, "", "q");
    const Eigen::Quaterniond predicted = quaternion_in(limb, "predicted", "Q");
    EXPECT_NEAR(tracked.norm(), 1.0, 1e-3);
    const Eigen::Vector3d bone = tracked * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d sensed = predicted * Eigen::Vector3d::UnitY();
    const double swing = std::atan2(bone.cross(sensed).norm(), bone.dot(sensed));
    EXPECT_NEAR(to_deg(swing), limb["swingDegrees"].get<double>(), 0.1) << limb;
    if (!limb.contains("twistDegrees")) continue;
    EXPECT_NEAR(to_deg(tracked.angularDistance(predicted)), limb["angleDegrees"].get<double>(),
                0.1);
  }
  service.take({frame_at(suit, 20.0), frame_at(suit, 22.0)});
  const json later = json::parse(get(router, "/evaluation").body);
  EXPECT_EQ(later["limbs"][0]["state"], "waiting");
  EXPECT_FALSE(later["limbs"][0].contains("predictedQx")) << "what is not judged has no axes";
}

TEST_F(ServedEvaluation, ListsTheErrorsAndTheCalibrations) {
  const json errors = json::parse(get(router, "/evaluation/segments").body);
  ASSERT_EQ(errors["segments"].size(), 1u);
  EXPECT_EQ(errors["segments"][0]["limb"], "ForearmLeft");
  EXPECT_FALSE(errors["segments"][0].contains("ended"));
  EXPECT_THAT(get(router, "/calibrations/").body, HasSubstr("suit"));
  const auto kept = resource::read_inertial_calibration(get(router, "/calibrations/suit").body,
                                                        resource::Format::Json);
  ASSERT_TRUE(kept) << to_string(kept.error());
  EXPECT_EQ(kept->sensors.size(), 3u);
  EXPECT_EQ(get(router, "/calibrations/other").status, 404);
  EXPECT_EQ(get(router, "/calibrations/no%20name").status, 404);
}

TEST_F(ServedEvaluation, ForgetsACalibrationWhenAsked) {
  const auto match = router.match("/calibrations/suit");
  const auto done = match->entry->actions.at(http::Method::Delete)({}, match->params);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->status, 204);
  EXPECT_EQ(get(router, "/calibrations/suit").status, 404);
  const auto other = router.match("/calibrations/other");
  EXPECT_FALSE(other->entry->actions.at(http::Method::Delete)({}, other->params));
}

TEST_F(ServedEvaluation, UsesOnlyDeclaredTerms) {
  LiveJudge judge(calibrated());
  testing::walk(judge, suit, 10.0, 10.5);
  const EvaluationResource evaluation{1, testing::kStart, "http://localhost/", judge.limbs()};
  EXPECT_EQ(resource::undeclared_terms(evaluation_node(evaluation)), std::vector<std::string>{});
  auto segments = judge.segments();
  ASSERT_FALSE(segments.empty());
  segments[0].segment.ended = testing::kStart;
  EXPECT_EQ(resource::undeclared_terms(segments_node(segments)), std::vector<std::string>{});
  EXPECT_EQ(resource::undeclared_terms(service::self_node(service.description())),
            std::vector<std::string>{});
}

TEST_F(ServedEvaluation, CountsForPrometheus) {
  service::MetricsText text;
  service.add_metrics(text);
  EXPECT_THAT(text.text(), HasSubstr("chorus_evaluation_limbs{state=\"off\"} 1\n"));
  EXPECT_THAT(text.text(), HasSubstr("chorus_evaluation_limbs{state=\"good\"} 2\n"));
  EXPECT_THAT(text.text(), HasSubstr("chorus_evaluation_segments_total 1\n"));
}

Result<EvaluationSettings> settings_of(const std::string& text) {
  return ConfigReader::parse(text, "c").and_then(&read_evaluation_settings);
}

TEST(EvaluationSettings, ShippedFileHoldsEveryDefault) {
  const auto text = read_file("deploy/config/evaluation.json", 1'000'000);
  ASSERT_TRUE(text);
  const auto shipped = settings_of(*text);
  ASSERT_TRUE(shipped) << to_string(shipped.error());
  EXPECT_TRUE(*shipped == *settings_of("{}"));
}

TEST(EvaluationSettings, NameSourcesAndLimbs) {
  const auto good = settings_of(
      R"({"inertial": [{"id": "suit", "url": "http://127.0.0.1:1/", "limbs": ["7=ShankLeft"]}]})");
  ASSERT_TRUE(good) << to_string(good.error());
  EXPECT_EQ(good->at_start.limbs.at(testing::sensor_id("suit")).at("7"), Limb::ShankLeft);
  const auto wrong = settings_of(
      R"({"inertial": [{"id": "s", "url": "http://127.0.0.1:1/", "limbs": ["7:ShankLeft"]},
                       {"id": "s", "url": "http://127.0.0.1:2/"}],
          "tracker": {"url": "somewhere"}, "threshold_deg": 2})");
  ASSERT_FALSE(wrong);
  for (const char* part :
       {"SENSOR=LIMB", "another inertial source", "tracker.url", "threshold_deg"})
    EXPECT_THAT(to_string(wrong.error()), HasSubstr(part));
}

TEST(EvaluationSettings, ACalibrationMustBeOfASourceThatIsFollowed) {
  const chorus::testing::TemporaryFolder folder;
  const auto text = resource::write(calibrated().calibrations.front(), resource::Format::Json);
  const std::string file = folder.write("suit.json", text).string();
  auto settings = settings_of(R"({"inertial": [{"id": "suit", "url": "http://127.0.0.1:1/"}]})");
  settings->at_start.calibration = file;
  const auto options = judge_options(*settings);
  ASSERT_TRUE(options) << to_string(options.error());
  EXPECT_EQ(options->calibrations.front().sensors.size(), 3u);
  settings->live.inertial.clear();
  EXPECT_THAT(to_string(judge_options(*settings).error()), HasSubstr("give one this id"));
  settings->at_start.calibration = file + ".gone";
  EXPECT_FALSE(EvaluationHost::make(*settings));
}

}  // namespace
}  // namespace chorus::evaluation_service
