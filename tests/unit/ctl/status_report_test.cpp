// What `chorus status` prints of sensors, clocks, bodies and the registration.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/ctl/operate/registration_report.h"
#include "tests/unit/ctl/program_run.h"
#include "tests/unit/ctl/scripted_server.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using Json = nlohmann::json;

/// What `chorus status` prints when the server gives these answers.
Outcome status_with(const Json& sensors, const Json& frame = {{"bodies", Json::array()}},
                    const Json& registration = Json::object()) {
  const ScriptedServer server(
      ScriptedServer::Texts{{"/sensors/", {Json{{"sensors", sensors}}.dump()}},
                            {"/registration", {registration.dump()}},
                            {"/frame", {frame.dump()}}});
  return run_chorus({"status", "--url", server.url()});
}

/// The line of a table that begins with this name.
std::string row_of(const std::string& text, const std::string& name) {
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with(name + " ")) return line;
  }
  return "no row " + name;
}

Json live(Json more = Json::object()) {
  more["state"] = "live";
  return more;
}

TEST(StatusTable, SaysFromWhatEachClockIsKnown) {
  const Json sensors{
      {"hosted", live({{"clockOffsetMilliseconds", 2.5}})},
      {"walked", live({{"clockOffsetMilliseconds", 40}, {"clockFromWalkMilliseconds", 40}})},
      {"aged", live({{"clockOffsetMilliseconds", 80},
                     {"clockFromWalkMilliseconds", 80},
                     {"clockFromAgeMilliseconds", 80}})},
      {"silent", live()}};
  const std::string text = status_with(sensors).out;
  EXPECT_THAT(row_of(text, "hosted"), MatchesRegex("hosted +live +- +- +2\\.500 +host +.*"));
  EXPECT_THAT(row_of(text, "walked"), MatchesRegex("walked +live +- +- +40\\.000 +walk +.*"));
  EXPECT_THAT(row_of(text, "aged"), MatchesRegex("aged +live +- +- +80\\.000 +age +.*"))
      << "a guess, though it came with a walk";
  EXPECT_THAT(row_of(text, "silent"), MatchesRegex("silent +live +- +- +- +- +.*"));
}

TEST(StatusTable, NamesItsColumnsAndTheirUnits) {
  const std::string text = status_with({{"s1", live()}}).out;
  EXPECT_THAT(
      lines_of(text).at(0),
      MatchesRegex("sensor +state +age \\[ms\\] +rate \\[Hz\\] +clock offset \\[ms\\] +from "
                   "+bodies +share +url"));
}

TEST(StatusTable, TellsOfHostsWhoseClockFollowsNoOther) {
  const Json sensors{{"free", live({{"hostSynchronised", false}})},
                     {"kept", live({{"hostSynchronised", true}})},
                     {"odd", live({{"hostSynchronised", "no"}})}};
  const std::string text = status_with(sensors).out;
  EXPECT_THAT(text,
              HasSubstr("free: the clock of its host follows no other (no NTP, chrony or PTP)"));
  EXPECT_THAT(text, Not(HasSubstr("kept: the clock")));
  EXPECT_THAT(text, Not(HasSubstr("odd: the clock"))) << "only what says so";
}

TEST(StatusTable, TellsOfAllSuchHostsInOneLineBehindWhatIsWrong) {
  const Json sensors{{"s1", live({{"hostSynchronised", false}})},
                     {"s2", {{"state", "lost"}, {"lastError", "Connection refused"}}},
                     {"s3", live({{"hostSynchronised", false}})}};
  const std::vector<std::string> lines = lines_of(status_with(sensors).out);
  EXPECT_EQ(lines.at(4), "s2: Connection refused");
  EXPECT_THAT(lines.at(5), HasSubstr("s1, s3: the clock of each host follows no other"));
  EXPECT_THAT(lines.at(6), HasSubstr("registration:"));
}

TEST(StatusTable, SaysWhenThereIsNoSensorAtAll) {
  const Outcome none = status_with(Json::object());
  EXPECT_EQ(none.code, kExitFailed);
  EXPECT_THAT(none.out, HasSubstr("no sensors are configured\n"));
  EXPECT_THAT(none.out, Not(HasSubstr("clock offset"))) << "no table without rows";
  EXPECT_EQ(none.error, "no sensor is live\n");
}

TEST(StatusTable, ShowsTheErrorOfASensorThatIsLiveAgain) {
  const Outcome told = status_with({{"s1", live({{"lastError", "a frame came late"}})}});
  EXPECT_EQ(told.code, kExitOk);
  EXPECT_THAT(told.out, HasSubstr("s1: a frame came late\n"));
}

TEST(StatusTable, TellsOnceWhomOtherSensorsContradict) {
  const std::string words = "s1, s2 see somebody at (1.2, -0.4) m, where s3 looks and sees nobody";
  const Json sensors{
      {"s1", live({{"contested", words}})}, {"s2", live({{"contested", words}})}, {"s3", live()}};
  const std::string text = status_with(sensors).out;
  const auto at = text.find("contested: " + words + "\n");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(text.find("contested", at + 1), std::string::npos);
}

TEST(StatusTable, AsksOnlySensorsThatAnswerWithoutFrames) {
  const ScriptedServer sensor(ScriptedServer::Texts{{"/healthz", {}}});
  const Json sensors{
      {"gone", {{"state", "lost"}, {"url", sensor.url()}, {"lastError", "no route to host"}}}};
  EXPECT_THAT(status_with(sensors).out, HasSubstr("gone: no route to host\n"));
  EXPECT_EQ(sensor.connections(), 0u) << "whoever cannot be reached has nothing to say";
}

TEST(StatusTable, ASensorThatIsWellAddsNoWords) {
  const ScriptedServer sensor(ScriptedServer::Texts{{"/healthz", {R"({"detail": "fine"})"}}});
  const Json sensors{{"s1",
                      {{"state", "connecting"},
                       {"url", sensor.url()},
                       {"lastError", "the sensor service answers 503"}}}};
  EXPECT_THAT(status_with(sensors).out, HasSubstr("s1: the sensor service answers 503\n"));
  EXPECT_EQ(sensor.connections(), 1u);
}

TEST(StatusTable, ShowsBodiesInMetresAndADashForWhatIsUnknown) {
  const Json frame{
      {"captured", "2026-11-22T10:00:00Z\x1b[2J"},
      {"bodies",
       {{{"bodyId", 12}, {"joints", {{"Head", {{"x", -0.1234}, {"y", 1.6}, {"z", 2.00049}}}}}},
        {{"joints", {{"Neck", {{"x", 1}}}}}}}}};
  const std::string text = status_with({{"s1", live()}}, frame).out;
  EXPECT_THAT(text, HasSubstr("fused bodies: 2, captured 2026-11-22T10:00:00Z?[2J\n"));
  EXPECT_THAT(text, HasSubstr("  body 12: head at -0.123 1.600 2.000\n"));
  EXPECT_THAT(text, HasSubstr("  body -: head at - - -\n"));
}

TEST(StatusTable, SaysNothingElseAsJson) {
  auto texts = ScriptedServer::Texts{{"/sensors/", {R"({"sensors": {"s1": {"state": "lost"}}})"}},
                                     {"/registration", {R"({"verdict": "Good"})"}},
                                     {"/frame", {R"({"bodies": []})"}}};
  const ScriptedServer server(texts);
  const Outcome told = run_chorus({"status", "--url", server.url(), "--json"});
  EXPECT_EQ(told.code, kExitFailed) << "no sensor is live, in either form";
  EXPECT_EQ(told.error, "");
  const Json json = Json::parse(told.out);
  EXPECT_EQ(json.size(), 6u) << "sensors, registration, frame, configuration, outputs, inertial";
  EXPECT_TRUE(json.at("frame").at("bodies").empty());
}

/// What a chorus-evaluation says of one limb.
Json told_limb(const std::string& state, const std::string& words) {
  return {{"state", state}, {"comment", words}};
}

TEST(StatusOfAJudgedTracker, SaysWhichLimbIsOffByHowMuchAndForHowLong) {
  const ScriptedServer evaluation(
      ScriptedServer::Texts{{"/evaluation",
                             {Json{{"limbs",
                                    {told_limb("good", "chest agrees"),
                                     told_limb("calibrating", "right shank: calibrates: walk"),
                                     told_limb("off", "left forearm off by 70 deg for 4 s"),
                                     told_limb("good", "pelvis agrees")}}}
                                  .dump()}}});
  const ScriptedServer server(
      ScriptedServer::Texts{{"/sensors/", {R"({"sensors": {"s1": {"state": "live"}}})"}},
                            {"/registration", {"{}"}},
                            {"/frame", {R"({"bodies": []})"}}});
  const Outcome told =
      run_chorus({"status", "--url", server.url(), "--evaluation", evaluation.url()});
  EXPECT_EQ(told.code, kExitOk);
  EXPECT_THAT(told.out, HasSubstr("judged by worn sensors: 2 limbs agree, 1 off, 1 not judged\n"
                                  "  left forearm off by 70 deg for 4 s\n"
                                  "  right shank: calibrates: walk\n"));
  const Outcome json =
      run_chorus({"status", "--url", server.url(), "--evaluation", evaluation.url(), "--json"});
  EXPECT_EQ(Json::parse(json.out).at("evaluation").at("limbs").size(), 4u);
}

TEST(StatusOfAJudgedTracker, TakesWhatTheTrackerRelays) {
  const ScriptedServer server(ScriptedServer::Texts{
      {"/sensors/", {R"({"sensors": {"s1": {"state": "live"}}})"}},
      {"/registration", {"{}"}},
      {"/frame", {R"({"bodies": []})"}},
      {"/evaluation", {Json{{"limbs", {told_limb("off", "head off by 50 deg for 1 s")}}}.dump()}}});
  EXPECT_THAT(run_chorus({"status", "--url", server.url()}).out,
              HasSubstr("  head off by 50 deg for 1 s\n"));
}

TEST(StatusOfAJudgedTracker, FailsIfTheEvaluationThatWasNamedDoesNotAnswer) {
  const ScriptedServer server(ScriptedServer::Texts{
      {"/sensors/", {R"({"sensors": {}})"}}, {"/registration", {"{}"}}, {"/frame", {"{}"}}});
  const ScriptedServer waiting(ScriptedServer::Texts{{"/evaluation", {}}});
  const Outcome told = run_chorus({"status", "--url", server.url(), "--evaluation", waiting.url()});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("evaluation"));
}

TEST(RegistrationReport, PutsAlarmsFirstAndWhatToDoNextLast) {
  const std::string text = registration_report(Json{{"verdict", "Good"},
                                                    {"master", "s1"},
                                                    {"awaits", {"walk in front of s2"}},
                                                    {"reasons", {"s2 is far"}},
                                                    {"alarms", {"s3 was moved"}}});
  EXPECT_EQ(text,
            "registration: Good, master s1\n"
            "  ALARM: s3 was moved\n"
            "  s2 is far\n"
            "  next: walk in front of s2\n");
}

TEST(RegistrationReport, SaysHowWellEachPlaceIsKnown) {
  const Json sensors{{"far", {{"x", 1.0}, {"presentRadius", 0.0414}, {"error", 0.005}}},
                     {"master", {{"x", 0.0}, {"error", 0.0}}}};
  const std::string text = registration_report({{"sensors", sensors}});
  EXPECT_THAT(text, HasSubstr("95 % [mm]"));
  EXPECT_THAT(row_of(text, "far"), MatchesRegex(".* 41 +5\\.0 .*"));
  EXPECT_THAT(row_of(text, "master"), MatchesRegex(".* - +0\\.0 .*"));
}

TEST(RegistrationReport, NamesThePairWhoseLoopsCloseWorst) {
  const Json edges = {{{"target", "s1"}, {"source", "s2"}, {"loopError", 0.004}},
                      {{"target", "s2"}, {"source", "s3"}, {"loopError", 0.0316}},
                      {{"target", "s1"}, {"source", "s3"}, {"loopError", 0.02}},
                      {{"target", "s1"}, {"source", "s4"}}};
  EXPECT_THAT(registration_report({{"edges", edges}}),
              HasSubstr("  loops close to within 32 mm (worst: s2 and s3)\n"));
  EXPECT_THAT(registration_report({{"edges", {edges[3]}}}), Not(HasSubstr("loops")));
  Json turned = edges[1];
  turned["loopDegrees"] = 0.254;
  EXPECT_THAT(registration_report({{"edges", {turned}}}), HasSubstr("within 32 mm, 0.25 deg ("));
}

TEST(RegistrationReport, TellsClocksThatDifferByMoreThanIsOpen) {
  const auto clock = [](double offset, double sigma) {
    return Json{{"clockOffsetMilliseconds", offset}, {"clockUncertaintyMilliseconds", sigma}};
  };
  const Json sensors{{"common", clock(5.0, 0.0)},
                     {"far", clock(-207.0, 2.0)},
                     {"near", clock(8.0, 2.0)},
                     {"none", Json::object()}};
  const std::string text = registration_report({{"sensors", sensors}});
  EXPECT_THAT(text, HasSubstr("  the clocks of common and far differ by 212 ms +- 4\n"));
  EXPECT_THAT(text, Not(HasSubstr("common and near"))) << "3 ms are within 1.96 sigma";
  EXPECT_THAT(text, Not(HasSubstr("common and common")));
  Json without = sensors;
  without.erase("common");
  EXPECT_THAT(registration_report({{"sensors", without}}), Not(HasSubstr("the clocks of")))
      << "nobody to compare with";
}

TEST(RegistrationReport, TellsLatenciesThatAreTakenOffAndThoseThatTheWalkLeavesOpen) {
  const auto latency = [](double found, double sigma, bool corrected) {
    return Json{{"latencyMilliseconds", found},
                {"latencyUncertaintyMilliseconds", sigma},
                {"latencyCorrected", corrected}};
  };
  const Json sensors{{"s1", latency(0.0, 0.0, false)},
                     {"s2", latency(42.1, 2.0, true)},
                     {"s3", latency(3.0, 2.0, false)},
                     {"s4", latency(30.0, 25.0, false)},
                     {"s5", Json::object()}};
  const std::string text = registration_report({{"sensors", sensors}});
  EXPECT_THAT(text, HasSubstr("  s2: latency 42 ms +- 4 relative to the others, taken off\n"));
  EXPECT_THAT(text, HasSubstr("  the walk does not tell the latency of s4: left at zero\n"));
  for (const char* sensor : {"s1", "s3", "s5"})
    EXPECT_THAT(text, Not(HasSubstr(std::string(sensor) + ": latency")));
}

TEST(RegistrationReport, SaysWhetherItIsKept) {
  const auto told = [](bool stored) {
    return registration_report({{"stored", stored}, {"storeProblem", "the disk is full"}});
  };
  EXPECT_THAT(told(false), HasSubstr("\n  not stored: the disk is full\n"));
  EXPECT_THAT(told(true), HasSubstr("\n  the disk is full\n")) << "a problem of before";
  EXPECT_THAT(registration_report({{"stored", false}}), Not(HasSubstr("not stored")))
      << "not asked for";
}

TEST(RegistrationReport, MarksSensorsThatAreNotPolledAndThoseWithoutAPlace) {
  const Json registration{
      {"sensors",
       {{"s1", {{"verdict", "Good"}, {"polled", true}, {"chain", {"s1"}}}},
        {"s2", {{"verdict", "Good"}, {"polled", false}, {"chain", {"s1", "s2"}}}}}},
      {"unplaced", {{"s9", {{"verdict", "Refused"}}}}}};
  const std::string text = registration_report(registration);
  EXPECT_THAT(row_of(text, "s1"), MatchesRegex("s1 +Good  +- .*"));
  EXPECT_THAT(row_of(text, "s2"), MatchesRegex("s2 +Good, not polled +- .*s1 > s2.*"));
  EXPECT_THAT(row_of(text, "s9"), MatchesRegex("s9 +Refused +- +- +- +- +- +- +- +-"));
}

TEST(RegistrationReport, ShowsPlacesErrorsAndTheNextBestChain) {
  const Json registration{{"sensors",
                           {{"s2",
                             {{"verdict", "Good"},
                              {"x", 1.23456},
                              {"y", -0.5},
                              {"z", 3},
                              {"qw", 0.9659258},
                              {"qx", 0},
                              {"qy", -0.258819},
                              {"qz", 0},
                              {"error", 0.0074},
                              {"chain", {"s1", "s3", "s2"}},
                              {"nextChain", {"s1", 7, "s2"}},
                              {"nextError", 0.024}}}}}};
  EXPECT_THAT(
      row_of(registration_report(registration), "s2"),
      MatchesRegex("s2 +Good +1\\.235 +-0\\.500 +3\\.000 +-30\\.0 +- +7\\.4 +s1 > s3 > s2 +s1 > "
                   "s2 \\(24\\.0 mm\\)"));
}

TEST(RegistrationReport, KeepsControlCharactersFromTheTerminal) {
  const std::string text =
      registration_report({{"verdict", "Good\x1b[1m"},
                           {"master", "s1\x07"},
                           {"storeProblem",
                            "a\x1b"
                            "b"},
                           {"alarms",
                            {"c\x1b"
                             "d"}},
                           {"edges", {{{"target", "\x1b"}, {"source", "s2"}, {"loopError", 1}}}}});
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  EXPECT_THAT(text, HasSubstr("Good?[1m, master s1?\n"));
}

}  // namespace
}  // namespace chorus::ctl
