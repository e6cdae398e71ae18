// chorus origin with a server whose answers are scripted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/ctl/program_run.h"
#include "tests/unit/ctl/scripted_server.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A person who stands at (1, -2) and faces +z.
std::string origin_frame_text(int index) {
  const auto at = [](double left) { return Json{{"x", 1.0 + left}, {"y", 1.0}, {"z", -2.0}}; };
  const Json joints{{"SpineBase", at(0)},
                    {"HipLeft", at(0.1)},
                    {"HipRight", at(-0.1)},
                    {"ShoulderLeft", at(0.2)},
                    {"ShoulderRight", at(-0.2)}};
  const Json body{{"sidesConfidence", 0.99}, {"joints", joints}};
  return Json{{"captured", "2026-11-22T10:00:0" + std::to_string(index % 10) + "Z"},
              {"bodies", Json::array({body})}}
      .dump();
}

/// The body of the only request for another origin.
Json origin_asked(const ScriptedServer& server) {
  constexpr std::string_view kAsked = "POST /registration/origin ";
  const auto written = server.written();
  EXPECT_EQ(written.size(), 1u);
  if (written.empty() || !written[0].starts_with(kAsked)) return Json::object();
  return Json::parse(written[0].substr(kAsked.size()));
}

TEST(Origin, ThePersonIsWatchedOnOneConnection) {
  std::vector<std::string> frames;
  for (int i = 0; i < 40; ++i) frames.push_back(origin_frame_text(i));
  const ScriptedServer server(ScriptedServer::Texts{{"/frame", frames}, {"/registration", {"{}"}}});
  const Outcome done = run_chorus({"origin", "--url", server.url(), "--here", "--seconds", "0.6"});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.error, HasSubstr("stand still for 0.6 s, facing the front\n"));
  const Json asked = origin_asked(server);
  EXPECT_NEAR(asked.at("x"), 1.0, 1e-9);
  EXPECT_NEAR(asked.at("z"), -2.0, 1e-9);
  EXPECT_NEAR(asked.at("yawDegrees"), 0.0, 1e-9) << "the person faces +z";
  EXPECT_LE(server.connections(), 4u)
      << "one to see that it is there, one for the frames, one before and one to set the origin";
}

TEST(Origin, HereIsWhereTheNamedJointIs) {
  std::vector<std::string> frames;
  for (int i = 0; i < 40; ++i) frames.push_back(origin_frame_text(i));
  const ScriptedServer server(ScriptedServer::Texts{{"/frame", frames}, {"/registration", {"{}"}}});
  const Outcome done = run_chorus(
      {"origin", "--url", server.url(), "--here", "--seconds", "0.6", "--with", "ShoulderLeft"});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  EXPECT_NEAR(origin_asked(server).at("x"), 1.2, 1e-9);
}

TEST(Origin, IsNotSetInAWorldThatWasChangedMeanwhile) {
  std::vector<std::string> frames;
  for (int i = 0; i < 40; ++i) frames.push_back(origin_frame_text(i));
  const ScriptedServer server(ScriptedServer::Texts{
      {"/frame", frames}, {"/registration", {R"({"version": 3})", R"({"version": 4})"}}});
  const Outcome done = run_chorus({"origin", "--url", server.url(), "--here", "--seconds", "0.6"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("the registration was changed while"));
  EXPECT_TRUE(server.written().empty());
}

TEST(Origin, NumbersHaveNoUnits) {
  const Outcome done = run_chorus({"origin", "--x", "1.2m"});
  EXPECT_EQ(done.code, kExitUsage);
  EXPECT_THAT(done.error, HasSubstr("1.2m is not a number (units are not written)"));
}

TEST(Origin, NobodyStandsStillWhileASessionRuns) {
  const ScriptedServer server(
      ScriptedServer::Texts{{"/registration", {R"({"session": {"state": "collecting"}})"}}});
  const Outcome done = run_chorus({"origin", "--url", server.url(), "--here"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("chorus register --cancel"));
}

/// One frame a second of a person who stands for 30 s at each of these places (x, z).
std::vector<std::string> standing(const std::vector<std::pair<double, double>>& places) {
  std::vector<std::string> frames;
  int index = 0;
  for (const auto& [x, z] : places) {
    for (int i = 0; i < 30; ++i, ++index) {
      const Json body{{"joints", {{"SpineBase", {{"x", x}, {"y", 1.0}, {"z", z}}}}}};
      const auto time = std::to_string(index / 600) + std::to_string(index / 60 % 10) + ":" +
                        std::to_string(index / 10 % 6) + std::to_string(index % 10);
      frames.push_back(
          Json{{"captured", "2026-11-22T10:" + time + "Z"}, {"bodies", Json::array({body})}}
              .dump());
    }
  }
  return frames;
}

TEST(Origin, IsWhereThePersonStandsFirstAndTheFrontWhereTheyStandNext) {
  const ScriptedServer server(ScriptedServer::Texts{{"/frame", standing({{1, 2}, {4, 2}, {2, 0}})},
                                                    {"/registration", {"{}"}}});
  const Outcome done =
      run_chorus({"origin", "--url", server.url(), "--points", "--seconds", "5", "--wait", "20"});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.error, HasSubstr("1 of 3: go to the point that shall be the origin"));
  EXPECT_THAT(done.error, HasSubstr("the marks are 3.00 m apart"));
  const Json asked = origin_asked(server);
  EXPECT_NEAR(asked.at("x"), 1.0, 1e-9);
  EXPECT_NEAR(asked.at("z"), 2.0, 1e-9);
  EXPECT_NEAR(asked.at("yawDegrees"), 90.0, 1e-9) << "they went along +x";
}

TEST(Origin, AThirdPointOnTheWrongSideIsRefused) {
  const ScriptedServer server(ScriptedServer::Texts{{"/frame", standing({{1, 2}, {4, 2}, {2, 4}})},
                                                    {"/registration", {"{}"}}});
  const Outcome done =
      run_chorus({"origin", "--url", server.url(), "--points", "--seconds", "5", "--wait", "20"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("on the right")) << "left of +x is -z";
  EXPECT_TRUE(server.written().empty());
}

TEST(Origin, IsFittedToMarksThatThePersonStandsOn) {
  const ScriptedServer server(
      ScriptedServer::Texts{{"/frame", standing({{1, 2}, {1, 5.04}})}, {"/registration", {"{}"}}});
  const Outcome done = run_chorus({"origin", "--url", server.url(), "--stand=0,1", "--stand=0,4",
                                   "--seconds", "5", "--wait", "20"});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.error, HasSubstr("2 of 2: go to x,z = 0,4"));
  EXPECT_THAT(done.error, HasSubstr("the distance between the marks is off by 40 mm"));
  const Json asked = origin_asked(server);
  EXPECT_NEAR(asked.at("x"), 1.0, 1e-9);
  EXPECT_NEAR(asked.at("z"), 1.02, 1e-9);
}

TEST(Origin, WhoNeverStandsStillIsGivenUp) {
  const ScriptedServer server(
      ScriptedServer::Texts{{"/frame", standing({{1, 2}})}, {"/registration", {"{}"}}});
  const Outcome done =
      run_chorus({"origin", "--url", server.url(), "--points", "--two", "--wait", "1"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("given up after 1 s: nobody has stood still there"));
  EXPECT_TRUE(server.written().empty());
}

TEST(Origin, IsFittedToMarksByNumbers) {
  const ScriptedServer server(ScriptedServer::Texts{{"/registration", {"{}"}}});
  const Outcome done = run_chorus(
      {"origin", "--url", server.url(), "--mark=1,2=0,0", "--mark=-1,2=0,2", "--mark=1,3=1,0"});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.error, HasSubstr("mark 3: 0 mm from where it shall be"));
  const Json asked = origin_asked(server);
  EXPECT_NEAR(asked.at("x"), 1.0, 1e-9);
  EXPECT_NEAR(asked.at("z"), 2.0, 1e-9);
  EXPECT_NEAR(asked.at("yawDegrees"), -90.0, 1e-9);
  const Outcome refused =
      run_chorus({"origin", "--url", server.url(), "--mark=1,2=0,0", "--mark=1,3=0,2"});
  EXPECT_EQ(refused.code, kExitFailed);
  EXPECT_EQ(server.written().size(), 1u) << "marks that do not fit move nothing";
}

TEST(Origin, NobodyThereIsSaid) {
  const ScriptedServer server(ScriptedServer::Texts{
      {"/frame", {R"({"captured": "x", "bodies": []})"}}, {"/registration", {"{}"}}});
  const Outcome done = run_chorus({"origin", "--url", server.url(), "--here", "--seconds", "0.5"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_EQ(done.error.find("/registration/origin"), std::string::npos);
}

TEST(Origin, AServerThatIsNotThereIsNamed) {
  std::string gone;
  gone = ScriptedServer(ScriptedServer::Texts{{"/frame", {"{}"}}}).url();
  const Outcome told = run_chorus({"origin", "--url", gone, "--here", "--seconds", "0.5"});
  EXPECT_THAT(told.error, HasSubstr("is chorus-fusion running there?"));
  EXPECT_EQ(told.error.find("stand still"), std::string::npos) << "nobody waits for nothing";
}

TEST(Origin, IsSetByNumbersInTheWorldAsItIs) {
  const ScriptedServer server(ScriptedServer::Texts{{"/registration", {R"({"verdict": "Good"})"}}});
  const Outcome done =
      run_chorus({"origin", "--url", server.url(), "--x", "1.5", "--z=-2", "--yaw", "90"});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  EXPECT_EQ(done.error, "") << "nobody has to stand still";
  EXPECT_THAT(done.out, HasSubstr("begins at what was x 1.500 m, z -2.000 m"));
  EXPECT_THAT(done.out, HasSubstr("its front is what was 90.0 deg\nregistration: Good"));
  const Json asked = origin_asked(server);
  EXPECT_EQ(asked.at("x"), 1.5);
  EXPECT_EQ(asked.at("z"), -2.0);
  EXPECT_NEAR(asked.at("yawDegrees"), 90.0, 1e-9);
}

TEST(Origin, OneNumberAloneLeavesTheRestWhereItIs) {
  const ScriptedServer server(ScriptedServer::Texts{{"/registration", {"{}"}}});
  ASSERT_EQ(run_chorus({"origin", "--url", server.url(), "--yaw=-30"}).code, kExitOk);
  const Json asked = origin_asked(server);
  EXPECT_EQ(asked.at("x"), 0.0);
  EXPECT_EQ(asked.at("z"), 0.0);
  EXPECT_NEAR(asked.at("yawDegrees"), -30.0, 1e-9);
}

TEST(Origin, ReportsTheServersAnswerAsJson) {
  const ScriptedServer server(
      ScriptedServer::Texts{{"/registration", {R"({"verdict": "Good", "version": 4})"}}});
  const Outcome set = run_chorus({"origin", "--url", server.url(), "--x", "1", "--json"});
  EXPECT_EQ(Json::parse(set.out).at("version"), 4);
  const Outcome shown = run_chorus({"origin", "--url", server.url(), "--json"});
  EXPECT_EQ(Json::parse(shown.out).at("verdict"), "Good");
  EXPECT_EQ(server.written().size(), 1u) << "showing it asks for nothing";
}

TEST(Origin, WhoeverMovesDoesNotSetIt) {
  std::vector<std::string> frames;
  for (int i = 0; i < 40; ++i) {
    Json frame = Json::parse(origin_frame_text(i));
    for (auto& joint : frame["bodies"][0]["joints"])
      joint["x"] = joint["x"].get<double>() + 0.2 * (i % 2);
    frames.push_back(frame.dump());
  }
  const ScriptedServer server(ScriptedServer::Texts{{"/frame", frames}, {"/registration", {"{}"}}});
  const Outcome done = run_chorus({"origin", "--url", server.url(), "--here", "--seconds", "0.6"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("stand still and retry"));
  EXPECT_TRUE(server.written().empty()) << "the world stays where it is";
}

TEST(Origin, TheSameFrameTwiceIsOneLook) {
  std::vector<std::string> frames;  // of one time, but not the same text
  for (std::size_t i = 0; i < 40; ++i) frames.push_back(origin_frame_text(1) + std::string(i, ' '));
  const ScriptedServer server(ScriptedServer::Texts{{"/frame", frames}, {"/registration", {"{}"}}});
  const Outcome done = run_chorus({"origin", "--url", server.url(), "--here", "--seconds", "0.5"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("too few frames came; is the tracker running?"));
}

TEST(Origin, RefusesPlacesAndTimesThatAreNone) {
  for (const auto& words : std::vector<std::vector<std::string>>{{"--x", "1001"},
                                                                 {"--z", "nan"},
                                                                 {"--yaw", "361"},
                                                                 {"--here", "--x", "1"},
                                                                 {"--here", "--seconds", "0.4"},
                                                                 {"--here", "--seconds", "31"},
                                                                 {"--seconds", "2"},
                                                                 {"--with", "feet", "--x", "1"},
                                                                 {"--mark=1,2=0,0"},
                                                                 {"--mark=1,2", "--mark=1,2=3,4"},
                                                                 {"--stand=1,2"},
                                                                 {"--points", "--here"},
                                                                 {"--points", "--stand=0,0"},
                                                                 {"--two"},
                                                                 {"--points", "--with", "Nose"}}) {
    std::vector<std::string> whole{"origin", "--url", "http://127.0.0.1:1/"};
    whole.insert(whole.end(), words.begin(), words.end());
    EXPECT_EQ(run_chorus(whole).code, kExitUsage) << ::testing::PrintToString(words);
  }
}

TEST(Origin, WithoutOptionsItIsShownWithTheWayBack) {
  const ScriptedServer server(ScriptedServer::Texts{
      {"/registration",
       {R"({"master": "s1", "sensors": {"s1": {"x": -1.5, "z": 2, "qw": 1, "qx": 0, "qy": 0, "qz": 0}}})",
        R"({"verdict": "None"})"}}});
  const Outcome told = run_chorus({"origin", "--url", server.url()});
  EXPECT_EQ(told.code, kExitOk) << told.error;
  EXPECT_THAT(told.out, HasSubstr("s1, stands at x -1.500 m, z 2.000 m"));
  EXPECT_THAT(told.out, HasSubstr("chorus origin --x=-1.5000 --z=2.0000 --yaw=0.00"));
  EXPECT_TRUE(server.written().empty());
  const Outcome none = run_chorus({"origin", "--url", server.url()});
  EXPECT_EQ(none.code, kExitOk);
  EXPECT_THAT(none.out, HasSubstr("no sensor is registered"));
}

}  // namespace
}  // namespace chorus::ctl
