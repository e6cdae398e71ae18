// What `chorus register` says while somebody walks, of proposals, and of earlier sessions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/ctl/register_answers.h"

namespace chorus::ctl {
namespace {

TEST(Register, SaysWhichSensorHasNoPlaceYet) {
  auto running = nlohmann::json::parse(session("collecting", "Provisional", true));
  running["accuracy"] = {{{"sensorId", "s2"}, {"expectedRadius", 0.05}}, {{"sensorId", "s3"}}};
  auto texts = walk(session("done", "Good", true));
  texts["/sessions/7"].insert(texts["/sessions/7"].begin(), running.dump());
  EXPECT_THAT(register_at(ScriptedServer(texts)).error,
              ::testing::HasSubstr("Provisional, s3 has no place yet"));
}

TEST(Register, LeavesOutWhatTheBarSaysAnyway) {
  auto running = nlohmann::json::parse(session("collecting", "None", false));
  running["awaits"] = {"keep walking: 20 s more", "stand in front of s2"};
  auto texts = walk(session("done", "Good", true));
  texts["/sessions/7"] = {running.dump(), running.dump(), session("done", "Good", true)};
  const std::string told = register_at(ScriptedServer(texts)).error;
  EXPECT_THAT(told, ::testing::Not(::testing::HasSubstr("keep walking")));
  const auto first = told.find("  stand in front of s2\n");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(told.find("  stand in front of s2\n", first + 1), std::string::npos)
      << "advice is repeated only when it changes";
}

TEST(Register, AProposalNamesTheSensorsThatItCouldNotPlace) {
  auto done = nlohmann::json::parse(session("done", "Good", false));
  done["sessionId"] = 7;
  done["accuracy"] = {{{"sensorId", "s2"}, {"expectedRadius", 0.02}}, {{"sensorId", "s3"}}};
  auto texts = walk(done.dump());
  auto waiting = nlohmann::json::parse(kIdle);
  waiting["sensors"]["s3"] = {{"verdict", "Good"}};  // its place of now is not the proposal's
  waiting["proposal"] = {{"sessionId", 7},
                         {"verdict", "Good"},
                         {"reasons", {"measure whether s1 is 3.10 m from it"}},
                         {"changes", nlohmann::json::array()}};
  texts["/registration"] = {kRuns, waiting.dump()};
  const Outcome told = register_at(ScriptedServer(texts), {"--propose"});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.out, ::testing::HasSubstr("proposed, not in use: Good"));
  EXPECT_THAT(told.out, ::testing::HasSubstr("measure whether s1 is 3.10 m from it"));
  EXPECT_THAT(told.error, ::testing::HasSubstr("s3 has no place: the walk lasted only 2 s\n"));
}

TEST(Register, ASensorWithoutAReasonStillGetsOne) {
  auto unplaced = nlohmann::json::parse(kIdle);
  unplaced["unplaced"]["s3"] = {{"verdict", "None"}};
  auto texts = walk(session("done", "Good", true));
  texts["/registration"] = {kRuns, unplaced.dump()};
  EXPECT_THAT(register_at(ScriptedServer(texts)).error,
              ::testing::HasSubstr("s3 has no place: the walk does not tell where it stands\n"));
}

TEST(Register, EveryDecisionHasAJsonForm) {
  const ScriptedServer server(ScriptedServer::Texts{
      {"/registration", {kRuns}}, {"/sessions/7", {session("cancelled", "None", false)}}});
  for (const char* decision : {"--accept", "--decline", "--undo"}) {
    const Outcome told = register_at(server, {decision, "--json"});
    EXPECT_EQ(told.code, kExitOk) << decision;
    EXPECT_EQ(nlohmann::json::parse(told.out).at("verdict"), "Good") << decision;
  }
  const Outcome cancelled = register_at(server, {"--cancel", "--json"});
  EXPECT_EQ(nlohmann::json::parse(cancelled.out).at("state"), "cancelled")
      << "of the session that it ended";
}

TEST(Register, HistoryKnowsTimesAndWhoBegan) {
  auto own = nlohmann::json::parse(session("done", "Good", true, 31.4));
  own["sessionId"] = 7;
  own["started"] = "2026-11-22T10:00:00Z";
  own["automatic"] = true;
  const ScriptedServer server(
      ScriptedServer::Texts{{"/registration", {R"({"sessions": ["/sessions/7", "/sessions/6"]})"}},
                            {"/sessions/7", {own.dump()}}});
  const Outcome told = register_at(server, {"--history"});
  EXPECT_EQ(told.code, kExitOk) << told.error;
  const auto lines = lines_of(told.out);
  ASSERT_EQ(lines.size(), 2u) << "session 6 was dropped in between, and is no failure";
  EXPECT_THAT(lines[1], ::testing::MatchesRegex("7 +2026-11-22T10:00:00Z +itself +31 +done +Good "
                                                "+yes +the walk lasted only 2 s"));
}

TEST(Register, HistoryOfAServerThatHasJustStarted) {
  const ScriptedServer server(ScriptedServer::Texts{{"/registration", {kIdle}}});
  const Outcome told = register_at(server, {"--history"});
  EXPECT_EQ(told.code, kExitOk);
  EXPECT_EQ(told.out, "no session since the server started\n");
  EXPECT_EQ(register_at(server, {"--history", "--json"}).out, "[]\n");
}

TEST(Register, AsksForThirtySecondsAndForNoProposal) {
  const ScriptedServer server(walk(session("done", "Good", true)));
  ASSERT_EQ(register_at(server).code, kExitOk);
  EXPECT_EQ(nlohmann::json::parse(server.written().at(0).substr(5)),
            nlohmann::json({{"seconds", 30.0}}));
}

TEST(Register, OneThingAtATime) {
  const std::vector<std::string> ways{"--fresh", "--accept",  "--decline",
                                      "--undo",  "--history", "--cancel"};
  for (const std::string& one : ways) {
    EXPECT_EQ(run_chorus({"register", "--propose", one}).code, kExitUsage) << one;
    for (const std::string& other : ways) {
      if (one == other) continue;
      EXPECT_EQ(run_chorus({"register", one, other}).code, kExitUsage) << one << other;
    }
  }
}

}  // namespace
}  // namespace chorus::ctl
