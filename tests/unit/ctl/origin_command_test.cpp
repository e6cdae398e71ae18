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
std::string frame_text(int index) {
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

TEST(Origin, ThePersonIsWatchedOnOneConnection) {
  std::vector<std::string> frames;
  for (int i = 0; i < 40; ++i) frames.push_back(frame_text(i));
  const ScriptedServer server(ScriptedServer::Texts{{"/frame", frames}, {"/registration", {"{}"}}});
  const Outcome done = run_chorus({"origin", "--url", server.url(), "--here", "--seconds", "0.6"});
  // The server of this test has no /registration/origin; only the request counts.
  EXPECT_THAT(done.error, HasSubstr("/registration/origin"));
  EXPECT_LE(server.connections(), 3u)
      << "one to see that it is there, one for the frames, one to set the origin";
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
