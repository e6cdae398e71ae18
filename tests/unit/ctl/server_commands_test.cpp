// `chorus status` and `chorus register` with a server whose answers are scripted.
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/unit/ctl/program_run.h"
#include "tests/unit/ctl/register_answers.h"
#include "tests/unit/ctl/scripted_server.h"

namespace chorus::ctl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

constexpr const char* kLive = R"({"sensors": {
  "s1": {"state": "live", "ageMilliseconds": 12.34, "rateHz": 29.97, "bodies": 2, "share": 0.995,
         "clockOffsetMilliseconds": -1.5, "url": "http://10.0.0.1:8081/"}}})";
constexpr const char* kFrame = R"({"captured": "2026-11-22T10:00:00Z", "bodies": [
  {"bodyId": 3, "joints": {"Head": {"x": 0.5, "y": 1.7, "z": -0.25}}}]})";

ScriptedServer::Texts calm() {
  return {{"/sensors/", {kLive}}, {"/registration", {kIdle}}, {"/frame", {kFrame}}};
}

Outcome status_of(const ScriptedServer& server, std::vector<std::string> more = {}) {
  std::vector<std::string> words{"status", "--url", server.url()};
  words.insert(words.end(), more.begin(), more.end());
  return run_chorus(words);
}

TEST(Status, ShowsSensorsRegistrationAndBodies) {
  const ScriptedServer server(calm());
  const Outcome told = status_of(server);
  EXPECT_EQ(told.code, kExitOk) << told.error;
  for (const char* part : {"s1", "live", "12.3", "30.0", "-1.500", "0.99", "http://10.0.0.1:8081/",
                           "registration: Good, master s1", "fused bodies: 1, captured 2026-11-22",
                           "body 3: head at 0.500 1.700 -0.250"})
    EXPECT_THAT(told.out, HasSubstr(part));
  EXPECT_EQ(told.error, "");
}

TEST(Status, FailsWhenNobodyIsLiveAndSaysWhy) {
  auto texts = calm();
  texts["/sensors/"] = {
      R"({"sensors": {"s1": {"state": "lost", "lastError": "refused\u001b[31m"}}})"};
  const Outcome told = status_of(ScriptedServer(texts));
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.out, HasSubstr("s1: refused"));
  EXPECT_THAT(told.out, Not(HasSubstr("\x1b"))) << "a sensor does not drive the terminal";
  EXPECT_EQ(told.error, "no sensor is live\n");
}

TEST(Status, OneLiveSensorIsEnough) {
  auto texts = calm();
  texts["/sensors/"] = {R"({"sensors": {"a": {"state": "lost"}, "b": {"state": "live"}}})"};
  EXPECT_EQ(status_of(ScriptedServer(texts)).code, kExitOk);
}

TEST(Status, AsksASilentSensorItselfWhatIsWrong) {
  const ScriptedServer sensor(ScriptedServer::Texts{{"/healthz", {}}});
  auto texts = calm();
  texts["/sensors/"] = {Json{{"sensors",
                              {{"s1",
                                {{"state", "connecting"},
                                 {"url", sensor.url()},
                                 {"lastError", "the sensor service answers 503"}}}}}}
                            .dump()};
  const Outcome told = status_of(ScriptedServer(texts));
  EXPECT_THAT(told.out, HasSubstr("the sensor service answers 503: nothing yet"));
}

TEST(Status, IsAStateBeforeTheFirstFrame) {
  auto texts = calm();
  texts["/frame"] = {};
  const ScriptedServer server(texts);
  const Outcome told = status_of(server);
  EXPECT_EQ(told.code, kExitOk) << told.error;
  EXPECT_THAT(told.out, HasSubstr("no fused frame yet"));
  const Json json = Json::parse(status_of(server, {"--json"}).out);
  EXPECT_TRUE(json.at("frame").is_null());
  EXPECT_EQ(json.at("sensors").at("s1").at("share"), 0.995);
  EXPECT_EQ(json.at("registration").at("master"), "s1");
}

TEST(Status, SurvivesAnyJson) {
  for (const char* text :
       {"null", "[]", "3", R"({"sensors": 3})", R"({"sensors": {"s1": null}})"}) {
    auto texts = calm();
    texts["/sensors/"] = {text};
    texts["/frame"] = {text};
    EXPECT_EQ(status_of(ScriptedServer(texts)).code, kExitFailed) << text;
  }
}

TEST(Status, TellsASensorFromAFusionServer) {
  const ScriptedServer sensor(
      ScriptedServer::Texts{{"/", {R"({"@type": ["Sensor"], "sensorId": "s1"})"}}});
  const Outcome told = status_of(sensor);
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("is sensor s1, not a fusion server"));
}

TEST(Status, AChainThatDoesNotExistHasNoError) {
  auto texts = calm();
  texts["/registration"] = {
      R"({"verdict": "Good", "sensors": {"s1": {"nextChain": [], "nextError": 0.0}}})"};
  EXPECT_THAT(status_of(ScriptedServer(texts)).out, Not(HasSubstr("- (0.0 mm)")));
}

TEST(Status, NamesTheServerThatIsNotThere) {
  std::string gone;
  gone = ScriptedServer(calm()).url();
  const Outcome told = run_chorus({"status", "--url", gone});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr(gone.substr(7, gone.size() - 8)));
}

TEST(Status, IsToldThoughTheEvaluationIsNotThere) {
  const ScriptedServer server(calm());
  const Outcome told = status_of(server, {"--evaluation", "http://127.0.0.1:1/"});
  EXPECT_EQ(told.code, kExitOk);
  EXPECT_THAT(told.out, HasSubstr("registration: Good"));
  EXPECT_THAT(told.error, HasSubstr("is chorus-evaluation running there?"));
}

TEST(Record, OfAHallWantsAServerThatBelongsToOne) {
  const ScriptedServer server(
      ScriptedServer::Texts{{"/", {R"({"@type":["Tracker"]})"}}, {"/sensors/", {kLive}}});
  const chorus::testing::TemporaryFolder folder;
  const Outcome told =
      run_chorus({"record", server.url(), "--site", "--out", (folder / "hall.mcap").string()});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("belongs to no site"));
}

TEST(Status, TakesTheServerFromTheSurroundings) {
  const ScriptedServer server(calm());
  ::setenv("CHORUS_URL", server.url().c_str(), 1);
  const Outcome told = run_chorus({"status"});
  ::unsetenv("CHORUS_URL");
  EXPECT_EQ(told.code, kExitOk) << told.error;
}

TEST(Register, FollowsItsSessionToTheVerdict) {
  const ScriptedServer server(walk(session("done", "Good", true)));
  const Outcome told = register_at(server, {"--seconds", "20"});
  EXPECT_EQ(told.code, kExitOk) << told.error;
  EXPECT_THAT(told.out, StartsWith("registration: Good, master s1"));
  EXPECT_THAT(told.error, HasSubstr("  walk in front of s2\n"));
  EXPECT_THAT(told.error, Not(HasSubstr("not good enough")));
  ASSERT_EQ(server.written().size(), 1u);
  EXPECT_EQ(Json::parse(server.written()[0].substr(5)).at("seconds"), 20.0);
}

TEST(Register, AnotherRegistrationInUseIsNoSuccess) {
  for (const auto& [verdict, adopted] :
       std::vector<std::pair<std::string, bool>>{{"Good", false}, {"Rejected", true}}) {
    const Outcome told = register_at(ScriptedServer(walk(session("done", verdict, adopted))));
    EXPECT_EQ(told.code, kExitFailed) << verdict;
    EXPECT_THAT(told.error, HasSubstr("not good enough:\n  the walk lasted only 2 s\n"));
  }
}

TEST(Register, ProvisionalIsInUseToo) {
  EXPECT_EQ(register_at(ScriptedServer(walk(session("done", "Provisional", true)))).code, kExitOk);
}

TEST(Register, ASensorWithoutAPlaceIsNoSuccessThoughTheRestIsGood) {
  const auto good = Json::parse(kIdle);
  auto unplaced = good;
  unplaced["unplaced"]["s3"] = {{"verdict", "Refused"}, {"reasons", {"a mirror"}}};
  auto refused = good;
  refused["sensors"]["s3"] = {{"verdict", "Refused"}, {"reasons", {"a mirror"}}};
  for (const Json& registration : {unplaced, refused}) {
    auto texts = walk(session("done", "Good", true));
    texts["/registration"] = {kRuns, registration.dump()};
    const Outcome told = register_at(ScriptedServer(texts));
    EXPECT_EQ(told.code, kExitFailed);
    EXPECT_THAT(told.out, StartsWith("registration: Good"));
    EXPECT_THAT(told.error, HasSubstr("s3 has no place: a mirror\n"));
    EXPECT_THAT(told.error, Not(HasSubstr("not good enough")));
  }
}

TEST(Register, WhatTheSessionCouldNotPlaceMayHaveAPlaceFromBefore) {
  auto done = Json::parse(session("done", "Good", true));
  done["accuracy"] = {{{"sensorId", "s2"}, {"expectedRadius", 0.02}}, {{"sensorId", "s3"}}};
  auto texts = walk(done.dump());
  const Outcome missing = register_at(ScriptedServer(texts));
  EXPECT_EQ(missing.code, kExitFailed);
  EXPECT_THAT(missing.error, HasSubstr("s3 has no place: the walk lasted only 2 s\n"));
  auto placed = Json::parse(kIdle);
  placed["sensors"]["s3"] = {{"verdict", "Good"}};
  texts["/registration"] = {kRuns, placed.dump()};
  EXPECT_EQ(register_at(ScriptedServer(texts)).code, kExitOk);
}

TEST(Register, CtrlCEndsTheCommandAndSaysThatTheSessionGoesOn) {
  const ScriptedServer server(walk(session("collecting", "None", false)));
  std::thread somebody([&] {
    while (server.written().empty()) std::this_thread::yield();
    ::kill(::getpid(), SIGINT);
  });
  const Outcome told = register_at(server);
  somebody.join();
  EXPECT_EQ(told.code, kExitInterrupted);
  EXPECT_THAT(told.error, HasSubstr("the session goes on"));
  EXPECT_THAT(told.error, HasSubstr("chorus register --cancel ends it"));
  EXPECT_EQ(server.written().size(), 1u) << "nothing was cancelled";
}

TEST(Register, SaysWhenSomebodyElseCancels) {
  const Outcome told = register_at(ScriptedServer(walk(session("cancelled", "None", false))));
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("the session ended early"));
}

TEST(Register, JoinsTheSessionThatRuns) {
  const ScriptedServer server(walk(session("done", "Good", true)),
                              Error{ErrorCode::Conflict, "registration", "one runs already"});
  const Outcome told = register_at(server);
  EXPECT_EQ(told.code, kExitOk) << told.error;
  EXPECT_THAT(told.error, HasSubstr("a session is running already"));
}

TEST(Register, PassesOnWhyItIsRefused) {
  auto texts = walk(session("done", "Good", true));
  texts["/registration"] = {kIdle};
  const ScriptedServer server(
      texts, Error{ErrorCode::Conflict, "registration", "no sensor is configured"});
  const Outcome told = register_at(server);
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("no sensor is configured"));
}

TEST(Register, AServerThatNamesNoSessionIsOlder) {
  const Outcome told = register_at(
      ScriptedServer(ScriptedServer::Texts{{"/registration", {R"({"verdict": "Good"})"}}}));
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("Is it an older server?"));
}

TEST(Register, ForgetsFirstWhenItIsToldTo) {
  const ScriptedServer server(walk(session("done", "Good", true)));
  EXPECT_EQ(register_at(server, {"--fresh"}).code, kExitOk);
  ASSERT_EQ(server.written().size(), 2u);
  EXPECT_EQ(server.written()[0], "DELETE /registration");
}

TEST(Register, CancelsOnlyWhatRuns) {
  const ScriptedServer running(ScriptedServer::Texts{{"/registration", {kRuns}}});
  EXPECT_EQ(register_at(running, {"--cancel"}).code, kExitOk);
  EXPECT_THAT(running.written(), ElementsAre("DELETE /sessions/7"));
  const ScriptedServer idle(ScriptedServer::Texts{{"/registration", {kIdle}}});
  const Outcome told = register_at(idle, {"--cancel"});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("no registration session runs"));
  EXPECT_TRUE(idle.written().empty());
}

TEST(Register, ReportsAsJson) {
  const Outcome told = register_at(ScriptedServer(walk(session("done", "Good", true))), {"--json"});
  const Json json = Json::parse(told.out);
  EXPECT_EQ(json.at("adopted"), true);
  EXPECT_EQ(json.at("registration").at("master"), "s1");
}

TEST(Register, UndoesAndSaysSoInWordsOrInJson) {
  const ScriptedServer server(ScriptedServer::Texts{{"/registration", {kIdle}}});
  EXPECT_THAT(register_at(server, {"--undo"}).out, HasSubstr("in use again"));
  const Outcome told = register_at(server, {"--undo", "--json"});
  EXPECT_EQ(told.code, kExitOk) << told.error;
  EXPECT_EQ(Json::parse(told.out).at("master"), "s1");
  EXPECT_THAT(server.written(), ElementsAre("POST /registration/undo", "POST /registration/undo"));
}

TEST(Register, ProposesWithTheNumbersOfOldAndNew) {
  auto done = Json::parse(session("done", "Good", false));
  done["sessionId"] = 7;
  auto texts = walk(done.dump());
  auto waiting = Json::parse(kIdle);
  waiting["proposal"] = {{"sessionId", 7},
                         {"verdict", "Good"},
                         {"changes",
                          {{{"sensorId", "s2"},
                            {"presentRadius", 0.041},
                            {"expectedRadius", 0.0232},
                            {"moves", 0.1174},
                            {"turnsDegrees", 1.26}}}}};
  texts["/registration"] = {kRuns, waiting.dump()};
  const ScriptedServer server(texts);
  const Outcome told = register_at(server, {"--propose"});
  EXPECT_EQ(told.code, kExitOk) << told.error;
  EXPECT_EQ(Json::parse(server.written()[0].substr(5)).at("adopt"), "when-accepted");
  EXPECT_THAT(told.out, HasSubstr("proposed, not in use: Good"));
  for (const char* number : {"41", "23", "117", "1.3"}) EXPECT_THAT(told.out, HasSubstr(number));
  EXPECT_THAT(told.error, Not(HasSubstr("not good enough")));
  done["sessionId"] = 8;  // what waits is another session's
  texts["/sessions/7"] = {done.dump()};
  EXPECT_EQ(register_at(ScriptedServer(texts), {"--propose"}).code, kExitFailed);
}

TEST(Register, AcceptsOrKeepsTheOld) {
  const ScriptedServer server(ScriptedServer::Texts{{"/registration", {kIdle}}});
  EXPECT_THAT(register_at(server, {"--accept"}).out,
              HasSubstr("the proposed registration is in use"));
  EXPECT_THAT(register_at(server, {"--decline"}).out, HasSubstr("stays in use"));
  EXPECT_EQ(register_at(server, {"--accept", "--decline"}).code, kExitUsage);
  EXPECT_THAT(server.written(),
              ElementsAre("POST /registration/accept", "POST /registration/decline"));
}

TEST(Register, ListsTheLastSessions) {
  const ScriptedServer server(ScriptedServer::Texts{
      {"/registration", {R"({"verdict": "Good", "sessions": ["/sessions/7", "/sessions/6"]})"}},
      {"/sessions/7", {session("done", "Refused", false)}},
      {"/sessions/6", {session("done", "Good", true)}}});
  const Outcome told = register_at(server, {"--history"});
  EXPECT_EQ(told.code, kExitOk) << told.error;
  EXPECT_THAT(told.out, HasSubstr("the walk lasted only 2 s"));
  EXPECT_LT(told.out.find("Refused"), told.out.find("Good"));
  EXPECT_EQ(Json::parse(register_at(server, {"--history", "--json"}).out).size(), 2u);
  EXPECT_TRUE(server.written().empty());
}

TEST(Register, SaysHowWellTheWalkPlacesTheSensorsSoFar) {
  auto running = Json::parse(session("collecting", "Provisional", true));
  running["targetRadius"] = 0.03;
  running["accuracy"] = {{{"sensorId", "s2"}, {"expectedRadius", 0.02}},
                         {{"sensorId", "s3"}, {"expectedRadius", 0.041}}};
  auto texts = walk(session("done", "Good", true));
  texts["/sessions/7"].insert(texts["/sessions/7"].begin(), running.dump());
  EXPECT_THAT(register_at(ScriptedServer(texts)).error, HasSubstr("worst s3 41 mm of 30"));
}

TEST(Register, RefusesWalksThatAreNoWalks) {
  for (const auto& words : std::vector<std::vector<std::string>>{{"--seconds", "0"},
                                                                 {"--seconds", "1e9"},
                                                                 {"--seconds", "nan"},
                                                                 {"--fresh", "--cancel"}}) {
    std::vector<std::string> whole{"register"};
    whole.insert(whole.end(), words.begin(), words.end());
    EXPECT_EQ(run_chorus(whole).code, kExitUsage) << words.back();
  }
}

}  // namespace
}  // namespace chorus::ctl
