// The registration on disk: what is written is read back, and nothing wrong is accepted.
#include "fusion-server/wire/registration_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fusion-server/wire/registration_nodes.h"
#include "tests/support/builders.h"

namespace chorus::wire {
namespace {

using testing::sensor_id;

Registration example() {
  Registration r;
  r.version = 3;
  r.solved = testing::kStart;
  r.verdict = Verdict::Provisional;
  r.reasons = {"the walk lasted only 6 s", "mit Umlaut: ä"};
  r.master = sensor_id("s2");
  for (int i = 0; i < 3; ++i) {
    Extrinsics& place = r.sensors[sensor_id("s" + std::to_string(i + 1))];
    place.world_from_sensor = testing::ring_sensor(i, 3);
    place.error = 0.01 * i;
    place.chain = {sensor_id("s2"), sensor_id("s" + std::to_string(i + 1))};
    place.covariance = Eigen::Matrix<double, 6, 6>::Identity() * (1e-6 * (i + 1));
  }
  PairwiseRegistration edge;
  r.verdicts[sensor_id("s1")] = {Verdict::Good, {}};
  r.verdicts[sensor_id("s2")] = {Verdict::Provisional, {"the walk lasted only 6 s"}};
  r.verdicts[sensor_id("s9")] = {Verdict::Refused, {"a coat stand"}};
  edge.target = sensor_id("s2");
  edge.source = sensor_id("s1");
  edge.rms = 0.02;
  edge.pairs = 640;
  edge.inliers = 601;
  r.edges.push_back(edge);
  r.clocks[sensor_id("s1")] = {std::chrono::milliseconds(-212), std::chrono::milliseconds(4)};
  r.clocks[sensor_id("s1")].stated = std::chrono::milliseconds(12);
  r.clocks[sensor_id("s1")].least_age = std::chrono::milliseconds(-204);
  r.clocks[sensor_id("s2")] = {};
  r.anchors = {
      {sensor_id("gone"), Eigen::Isometry3d(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()))}};
  r.latencies[sensor_id("s2")] = {std::chrono::milliseconds(42), std::chrono::milliseconds(2),
                                  true};
  r.latencies[sensor_id("s3")] = {std::chrono::milliseconds(-1), std::chrono::milliseconds(3)};
  r.edges.back().apart = 0.012;
  r.edges.back().loop_turn = 0.003;
  r.sensors.at(sensor_id("s3")).next_chain = {sensor_id("s2"), sensor_id("s1"), sensor_id("s3")};
  r.sensors.at(sensor_id("s3")).next_error = 0.034;
  r.sensors.at(sensor_id("s2")).scale = 1.0625;
  return r;
}

std::string why(std::string_view text) {
  const auto read = read_registration(text);
  return read ? "" : to_string(read.error());
}

TEST(RegistrationFile, ReadsWhatItWrites) {
  const Registration written = example();
  const auto read = read_registration(write_registration(written));
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->version, 3u);
  EXPECT_EQ(read->solved, written.solved);
  EXPECT_EQ(read->verdict, Verdict::Provisional);
  EXPECT_EQ(read->reasons, written.reasons);
  EXPECT_EQ(read->master, written.master);
  ASSERT_EQ(read->clocks.size(), 2u);
  EXPECT_EQ(read->clocks.at(sensor_id("s1")).added, std::chrono::milliseconds(-212));
  EXPECT_EQ(read->clocks.at(sensor_id("s1")).sigma, std::chrono::milliseconds(4));
  EXPECT_EQ(read->clocks.at(sensor_id("s2")).sigma, Duration{0});
  EXPECT_EQ(read->clocks.at(sensor_id("s1")).stated, std::chrono::milliseconds(12));
  EXPECT_EQ(read->clocks.at(sensor_id("s1")).least_age, std::chrono::milliseconds(-204));
  EXPECT_FALSE(exchanges_time(seconds(read->clocks.at(sensor_id("s2")).stated)));
  EXPECT_FALSE(read->clocks.at(sensor_id("s2")).least_age);
  EXPECT_EQ(read->anchors.at(sensor_id("gone")).matrix(),
            written.anchors.at(sensor_id("gone")).matrix());
  EXPECT_EQ(read->latencies, written.latencies);
  EXPECT_EQ(read->edges.at(0).apart, 0.012);
  EXPECT_NEAR(*read->edges.at(0).loop_turn, 0.003, 1e-12);
  EXPECT_FALSE(read->edges.at(0).loop);
  EXPECT_EQ(read->sensors.at(sensor_id("s3")).next_chain.size(), 3u);
  EXPECT_EQ(read->sensors.at(sensor_id("s2")).scale, 1.0625);
  EXPECT_EQ(read->sensors.at(sensor_id("s3")).scale, 1.0);
  EXPECT_EQ(read->sensors.at(sensor_id("s3")).next_error, 0.034);
  EXPECT_TRUE(read->sensors.at(sensor_id("s1")).next_chain.empty());
  ASSERT_EQ(read->sensors.size(), 3u);
  for (const auto& [id, place] : written.sensors) {
    const Extrinsics& again = read->sensors.at(id);
    EXPECT_EQ(again.world_from_sensor.matrix(), place.world_from_sensor.matrix()) << "to the bit";
    EXPECT_EQ(again.covariance, place.covariance);
    EXPECT_EQ(again.chain, place.chain);
    EXPECT_EQ(again.error, place.error);
  }
  ASSERT_EQ(read->verdicts.size(), 4u);
  EXPECT_EQ(read->verdicts.at(sensor_id("s1")).verdict, Verdict::Good);
  EXPECT_EQ(read->verdicts.at(sensor_id("s2")).reasons, std::vector{written.reasons.front()});
  EXPECT_EQ(read->verdicts.at(sensor_id("s3")).verdict, Verdict::Provisional) << "as all together";
  EXPECT_EQ(read->verdicts.at(sensor_id("s9")).verdict, Verdict::Refused);
  ASSERT_EQ(read->edges.size(), 1u);
  EXPECT_EQ(read->edges[0].pairs, 640u);
  EXPECT_EQ(read->edges[0].inliers, 601u);
}

TEST(RegistrationFile, ReadsASavedAnswerOfTheService) {
  const auto text = write(registration_node(example(), {}), resource::Format::Json);
  const auto read = read_registration(text);
  ASSERT_TRUE(read) << to_string(read.error()) << text;
  EXPECT_EQ(read->latencies, example().latencies);
  for (const auto& [id, place] : example().sensors) {
    EXPECT_TRUE(read->sensors.at(id).world_from_sensor.isApprox(place.world_from_sensor, 1e-4));
    EXPECT_TRUE(read->sensors.at(id).covariance.isApprox(place.covariance, 1e-4))
        << "chorus record has no other source";
  }
}

TEST(RegistrationFile, GivenPlacesAloneAreAGoodRegistration) {
  const auto read = read_registration(
      R"({"sensors": {"cam01": {"x": 1, "y": 2, "z": 3, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}})");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->verdict, Verdict::Good);
  EXPECT_EQ(read->master, sensor_id("cam01"));
  EXPECT_EQ(read->sensors.begin()->second.chain, std::vector{sensor_id("cam01")});
}

TEST(RegistrationFile, NamesWhatIsWrong) {
  EXPECT_NE(why(""), "");
  EXPECT_NE(why("[]"), "");
  EXPECT_NE(why("{}"), "");
  EXPECT_NE(why(R"({"sensors": {}})"), "");
  EXPECT_NE(why(std::string(20000, '[')), "");
  EXPECT_NE(why(std::string(5u << 20, ' ')), "");
  EXPECT_NE(why(R"({"sensors": {"s/1": {}}})").find("s/1"), std::string::npos);
  const std::string head = R"({"sensors": {"s1": {"x": 1, "y": 2, "z": )";
  EXPECT_NE(why(head + R"("3", "qx": 0, "qy": 0, "qz": 0, "qw": 1}}})").find("s1.z"),
            std::string::npos);
  EXPECT_NE(why(head + R"(1e9, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}})").find("s1.z"),
            std::string::npos);
  EXPECT_NE(why(head + R"(3, "qx": 0, "qy": 0, "qz": 0, "qw": 0}}})").find("unit"),
            std::string::npos);
  EXPECT_NE(
      why(head + R"(3, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}, "verdict": "Fine"})").find("Fine"),
      std::string::npos);
  EXPECT_NE(why(head + R"(3, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}, "master": "s9"})").find("s9"),
            std::string::npos);
  EXPECT_NE(
      why(head + R"(3, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}, "solved": "soon"})").find("solved"),
      std::string::npos);
  const std::string turned = R"(3, "qx": 0, "qy": 0, "qz": 0, "qw": 1, "rotation": )";
  EXPECT_NE(why(head + turned + "[0,1,0,-1,0,0,0,0,1]}}}").find("differs"), std::string::npos);
  EXPECT_NE(why(head + turned + "[1,0,0,0,1,0,0,0]}}}").find("rotation"), std::string::npos);
  EXPECT_NE(why(head + turned + "7}}}").find("rotation"), std::string::npos);
  EXPECT_NE(why(head + R"(3, "qx": 0, "qy": 0, "qz": 0, "qw": 1, "verdict": 3}}})").find("verdict"),
            std::string::npos);
  EXPECT_NE(why(head + R"(3, "qx": 0, "qy": 0, "qz": 0, "qw": 1, "covariance": [1]}}})")
                .find("covariance"),
            std::string::npos);
}

/// The example with one value replaced.
std::string with(const std::string& pointer, const nlohmann::json& value) {
  auto json = nlohmann::json::parse(write_registration(example()));
  json[nlohmann::json::json_pointer(pointer)] = value;
  return why(json.dump());
}

TEST(RegistrationFile, SaysWhatToChange) {
  const auto place = [](const std::string& x, const std::string& qw) {
    return why(R"({"sensors": {"a": {"x": )" + x +
               R"(, "y": 0, "z": 0, "qx": 0, "qy": 0, "qz": 0, "qw": )" + qw + "}}}");
  };
  EXPECT_EQ(
      place("1460.2", "1"),
      "registration: sensors.a.x: 1460.2 is beyond 1000, the most that is read; places are in "
      "metres: is it in millimetres?");
  EXPECT_EQ(place("1", "5"),
            "registration: sensors.a: qx qy qz qw is not a unit quaternion: its length is 5");
  EXPECT_EQ(place("NaN", "1").find("registration: line 1, column"), 0U) << place("NaN", "1");
  EXPECT_NE(why(R"({"fx": 1, "cx": 2})").find("this is the lens of a camera"), std::string::npos);
  EXPECT_NE(why(R"({"restMm": []})").find("this is a hand"), std::string::npos);
}

TEST(RegistrationFile, NamesTheMemberThatIsOfTheWrongKind) {
  for (const char* member : {"/master", "/verdict", "/solved", "/edges/0/source"}) {
    const std::string told = with(member, 5);
    EXPECT_NE(told.find("a text is wanted"), std::string::npos) << member << ": " << told;
    EXPECT_EQ(told.find("json.exception"), std::string::npos) << told;
  }
  EXPECT_NE(with("/edges/0/source", 5).find("edges.source"), std::string::npos);
}

TEST(RegistrationFile, ACovarianceCanBeOne) {
  const std::string covariance = "/sensors/s1/covariance";
  EXPECT_NE(with(covariance + "/0", -1).find("negative"), std::string::npos);
  EXPECT_NE(with(covariance + "/35", 1e300).find("large"), std::string::npos);
  EXPECT_NE(with(covariance + "/1", 0.5).find("symmetric"), std::string::npos);
  EXPECT_EQ(with(covariance + "/0", 2e-6), "");
}

TEST(RegistrationFile, EveryPrefixOfAFileIsRefusedAndNoneCrashes) {
  const std::string text = write_registration(example());
  for (std::size_t n = 0; n + 2 < text.size(); n += 7) {
    EXPECT_FALSE(read_registration(std::string_view(text).substr(0, n))) << n;
  }
}

TEST(RegistrationNode, UsesOnlyDeclaredTermsAndNamesTheVerdict) {
  SessionStatus session;
  session.id = 12;
  session.state = SessionState::Collecting;
  session.elapsed = 3;
  session.target = 30;
  session.reasons = {"why not"};
  RegistrationProgress progress;
  progress.sessions = {session};
  progress.awaits = {"keep walking: 27 s more"};
  progress.storage.folder = "/var/lib/chorus";
  const auto node = registration_node(example(), progress);
  EXPECT_EQ(resource::undeclared_terms(node), std::vector<std::string>{});
  EXPECT_EQ(resource::undeclared_terms(registration_node({}, {})), std::vector<std::string>{});
  EXPECT_EQ(resource::undeclared_terms(session_node(session, progress.awaits)),
            std::vector<std::string>{});
  const auto json = nlohmann::json::parse(write(node, resource::Format::Json));
  EXPECT_EQ(json["verdict"], "Provisional");
  EXPECT_EQ(json["session"]["state"], "collecting");
  EXPECT_EQ(json["session"]["progress"], "/registration/sessions/12");
  EXPECT_EQ(json["awaits"][0], "keep walking: 27 s more");
  EXPECT_EQ(json["stored"], true);
  EXPECT_EQ(json["sensors"]["s1"]["verdict"], "Good");
  EXPECT_EQ(json["sensors"]["s3"]["verdict"], "Provisional");
  EXPECT_EQ(json["unplaced"]["s9"]["reasons"][0], "a coat stand");
  const auto turtle = write(node, resource::Format::Turtle);
  EXPECT_NE(turtle.find("ch:sessionState \"collecting\""), std::string::npos) << turtle;
  EXPECT_NE(turtle.find("ch:verdict ch:Provisional"), std::string::npos);
}

TEST(RegistrationNode, SaysWhyItIsNotStoredAndIdleWhenNoSessionRuns) {
  RegistrationProgress progress;
  auto json =
      nlohmann::json::parse(write(registration_node(example(), progress), resource::Format::Json));
  EXPECT_EQ(json["stored"], false);
  EXPECT_EQ(json["session"]["state"], "idle");
  EXPECT_FALSE(json["session"].contains("sessionId"));
  progress.storage = {"/nowhere", "/nowhere: read-only", {}, false};
  progress.sessions.resize(1);
  progress.sessions[0].id = 3;
  json =
      nlohmann::json::parse(write(registration_node(example(), progress), resource::Format::Json));
  EXPECT_EQ(json["storeProblem"], "/nowhere: read-only");
  EXPECT_EQ(json["session"]["state"], "idle");
  EXPECT_EQ(json["session"]["sessionId"], 3);
}

TEST(RegistrationNode, IsStoredOnceTheFileHoldsItAndTellsOfADamagedOne) {
  RegistrationProgress progress;
  progress.storage.folder = "/var/lib/chorus";
  const auto shown = [&progress] {
    return nlohmann::json::parse(
        write(registration_node(example(), progress), resource::Format::Json));
  };
  EXPECT_EQ(shown()["stored"], true);
  progress.own_provisional = true;
  EXPECT_EQ(shown()["stored"], false);
  EXPECT_FALSE(shown().contains("storeProblem")) << "that is no problem";
  progress.own_provisional = false;
  progress.storage.writing = true;
  EXPECT_EQ(shown()["stored"], false);
  progress.storage.writing = false;
  progress.storage.damage = "it was cut off";
  EXPECT_EQ(shown()["stored"], true);
  EXPECT_EQ(shown()["storeProblem"], "it was cut off");
}

TEST(RegistrationNode, MarksSensorsThatNobodyPolls) {
  RegistrationProgress progress;
  progress.unpolled = {sensor_id("s3")};
  const auto node = registration_node(example(), progress);
  EXPECT_EQ(resource::undeclared_terms(node), std::vector<std::string>{});
  const auto json = nlohmann::json::parse(write(node, resource::Format::Json));
  EXPECT_EQ(json["sensors"]["s3"]["polled"], false);
  EXPECT_FALSE(json["sensors"]["s1"].contains("polled"));
}

TEST(SessionNode, TellsOutcomeAndStopsAwaitingWhenItIsOver) {
  SessionStatus session;
  session.id = 12;
  session.state = SessionState::Done;
  session.verdict = Verdict::Refused;
  session.reasons = {"why not"};
  const auto over =
      nlohmann::json::parse(write(session_node(session, {"a"}), resource::Format::Json));
  EXPECT_EQ(over["state"], "done");
  EXPECT_EQ(over["verdict"], "Refused");
  EXPECT_EQ(over["adopted"], false);
  EXPECT_EQ(over["reasons"][0], "why not");
  EXPECT_FALSE(over.contains("awaits"));
  session.state = SessionState::Solving;
  EXPECT_EQ(nlohmann::json::parse(
                write(session_node(session, {"a"}), resource::Format::Json))["awaits"][0],
            "a");
}

TEST(Verdicts, HaveNamesBothWays) {
  for (const Verdict v : {Verdict::None, Verdict::Provisional, Verdict::Good, Verdict::Refused}) {
    EXPECT_EQ(verdict_named(name_of(v)), v);
  }
  EXPECT_FALSE(verdict_named("good"));
}

}  // namespace
}  // namespace chorus::wire
