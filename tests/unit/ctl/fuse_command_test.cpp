// chorus fuse, from recordings to fused frames, without a process or a socket.
#include <regex>

#include <nlohmann/json.hpp>

#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using chorus::testing::bytes_of;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

/// Position of the first body's head; none if nobody is there or the head is not seen.
std::optional<Eigen::Vector3d> head_of(const Json& frame) {
  if (!frame.contains("bodies") || frame.at("bodies").empty()) return std::nullopt;
  const Json& head = frame.at("bodies")[0].at("joints").at("Head");
  if (!head.contains("x")) return std::nullopt;
  return Eigen::Vector3d(head.at("x"), head.at("y"), head.at("z"));
}

TEST(FuseCommand, RegistersFromTheWalkAndFusesIt) {
  const Cell cell;
  const std::string out = cell.file("fused.ndjson");
  const Outcome done = run_chorus({"fuse", cell.recordings(), "--out", out});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.error, HasSubstr("registration: Provisional"));
  EXPECT_THAT(done.error, HasSubstr("3 sensors, "));
  EXPECT_EQ(done.out, "");
  const auto lines = lines_of(bytes_of(out));
  ASSERT_GT(lines.size(), 150u);
  std::size_t with_head = 0;
  for (const std::string& line : lines) {
    const auto head = head_of(Json::parse(line));
    if (!head) continue;
    ++with_head;
    EXPECT_NEAR(head->y(), 1.6, 0.15) << "on the floor, upright";
    EXPECT_LT(head->norm(), 6.0);
  }
  EXPECT_GT(with_head, 140u);
}

TEST(FuseCommand, TheSameRecordingsGiveTheSameBytes) {
  const Cell cell(4.0);
  const Outcome first = run_chorus({"fuse", cell.recordings(), "--out", "-"});
  const Outcome second = run_chorus({"fuse", cell.recordings(), "--out", "-"});
  EXPECT_FALSE(first.out.empty());
  EXPECT_EQ(first.out, second.out);
  const std::string one = cell.file("one.mcap");
  const std::string two = cell.file("two.mcap");
  EXPECT_EQ(run_chorus({"fuse", cell.recordings(), "--out", one}).code, kExitOk);
  EXPECT_EQ(run_chorus({"fuse", cell.recordings(), "--out", two}).code, kExitOk);
  EXPECT_EQ(bytes_of(one), bytes_of(two));
}

TEST(FuseCommand, ASavedRegistrationStandsInForTheWalk) {
  const Cell cell(4.0);
  const std::string places = cell.file("places.json");
  const Outcome walked = run_chorus(
      {"fuse", cell.recordings(), "--out", "-", "--save-registration", places, "--json"});
  ASSERT_EQ(walked.code, kExitOk) << walked.error;
  const Json summary = Json::parse(walked.error);
  EXPECT_EQ(summary.at("sensors"), 3);
  EXPECT_EQ(summary.at("registration").at("sensors").size(), 3u);
  EXPECT_GT(summary.at("framesWithBodies"), 0);
  const Outcome again =
      run_chorus({"fuse", cell.recordings(), "--out", "-", "--registration", places});
  ASSERT_EQ(again.code, kExitOk) << again.error;
  EXPECT_EQ(lines_of(again.out).size(), lines_of(walked.out).size());
  const auto first = head_of(Json::parse(lines_of(walked.out).back()));
  const auto second = head_of(Json::parse(lines_of(again.out).back()));
  ASSERT_TRUE(first && second);
  EXPECT_LT((*first - *second).norm(), 1e-3);
}

/// The summary of fusing a cell that has a registration.json beside its recordings.
Json summary_with_places_beside(const Cell& cell, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words{"fuse", cell.recordings(), "--out", "-", "--json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome done = run_chorus(words);
  EXPECT_EQ(done.code, kExitOk) << done.error;
  return Json::parse(done.error);
}

TEST(FuseCommand, TakesTheRegistrationBesideTheRecordingsAndSaysSo) {
  const Cell cell(4.0);
  const std::string beside = cell.recordings() + "/registration.json";
  ASSERT_EQ(
      run_chorus({"fuse", cell.recordings(), "--out", "-", "--save-registration", beside}).code,
      kExitOk);
  Json places = Json::parse(bytes_of(beside));
  places["reasons"] = {"published with the recording"};
  std::ofstream(beside) << places.dump();
  const Json taken = summary_with_places_beside(cell);
  EXPECT_EQ(taken.at("registration").at("reasons"), places.at("reasons"));
  EXPECT_THAT(taken.at("notes").dump(), HasSubstr(beside + " says"));
  const Json ignored = summary_with_places_beside(cell, {"--distance", "s1,s2=3"});
  EXPECT_THAT(ignored.at("notes").dump(), HasSubstr("change nothing without --from-walk"));
  const Json walked = summary_with_places_beside(cell, {"--from-walk"});
  EXPECT_NE(walked.at("registration").at("reasons"), places.at("reasons"));
  EXPECT_TRUE(walked.at("notes").empty());
  places["reasons"] = {"given"};
  std::ofstream(cell.file("given.json")) << places.dump();
  const Json given = summary_with_places_beside(cell, {"--registration", cell.file("given.json")});
  EXPECT_EQ(given.at("registration").at("reasons"), places.at("reasons"));
  EXPECT_TRUE(given.at("notes").empty());
  EXPECT_THAT(run_chorus({"fuse", cell.recordings(), "--out", beside}).error,
              HasSubstr("would destroy it"));
}

TEST(FuseCommand, ARegistrationBesideThatDoesNotFitIsNotTakenInSilence) {
  const Cell cell(4.0);
  const std::string beside = cell.recordings() + "/registration.json";
  std::ofstream(beside) << "{\"sensors\": 3";
  const Outcome broken = run_chorus({"fuse", cell.recordings(), "--out", "-"});
  EXPECT_EQ(broken.code, kExitFailed);
  EXPECT_THAT(broken.error, HasSubstr(beside));
  EXPECT_THAT(broken.error, HasSubstr("--from-walk"));
  ASSERT_EQ(run_chorus({"fuse", cell.recordings(), "--out", "-", "--from-walk",
                        "--save-registration", beside})
                .code,
            kExitOk);
  const std::string ours = bytes_of(beside);
  std::ofstream(beside) << std::regex_replace(ours, std::regex("\\bs([123])\\b"), "t$1");
  EXPECT_THAT(summary_with_places_beside(cell).at("notes").dump(),
              HasSubstr("is of other sensors, and is not used"));
}

TEST(FuseCommand, TheMethodAndEveryOtherKeyCanBeChosen) {
  const Cell cell(4.0);
  for (const char* method : {"otto", "mean", "best-view"}) {
    const Outcome done = run_chorus({"fuse", cell.recordings(), "--out", "-", "--method", method});
    EXPECT_EQ(done.code, kExitOk) << method << done.error;
  }
  const Outcome slow =
      run_chorus({"fuse", cell.recordings(), "--out", "-", "--set", "output.rate_hz=10"});
  EXPECT_EQ(slow.code, kExitOk) << slow.error;
  EXPECT_NEAR(static_cast<double>(lines_of(slow.out).size()), 40.0, 3.0);
  const Outcome wrong =
      run_chorus({"fuse", cell.recordings(), "--out", "-", "--set", "output.rate_hertz=10"});
  EXPECT_EQ(wrong.code, kExitFailed);
  EXPECT_THAT(wrong.error, HasSubstr("rate_hz"));
  EXPECT_EQ(wrong.out, "");
}

TEST(FuseCommand, NeverWritesOverWhatItReadsOrOverARecording) {
  const Cell cell(2.0);
  const std::string input = cell.recordings() + "/s1.mcap";
  const std::string before = bytes_of(input);
  EXPECT_EQ(run_chorus({"fuse", cell.recordings(), "--out", input}).code, kExitFailed);
  const std::string places = cell.file("places.json");
  ASSERT_EQ(
      run_chorus({"fuse", cell.recordings(), "--out", "-", "--save-registration", places}).code,
      kExitOk);
  const Outcome over =
      run_chorus({"fuse", cell.recordings(), "--registration", places, "--out", places});
  EXPECT_EQ(over.code, kExitFailed);
  EXPECT_THAT(over.error, HasSubstr("would destroy it"));
  EXPECT_EQ(bytes_of(input), before);
  const std::string fused = cell.file("fused.mcap");
  ASSERT_EQ(run_chorus({"fuse", cell.recordings(), "--out", fused}).code, kExitOk);
  EXPECT_THAT(run_chorus({"fuse", cell.recordings(), "--out", fused}).error,
              HasSubstr("never overwritten"));
}

TEST(FuseCommand, AMeasuredDistanceIsHeldAgainstTheWalk) {
  const Cell cell(4.0);
  const auto with = [&](const char* distance) {
    return run_chorus(
        {"fuse", cell.recordings(), "--from-walk", "--distance", distance, "--out", "-"});
  };
  const Outcome unknown = with("s1,s9=3");
  EXPECT_EQ(unknown.code, kExitFailed);
  EXPECT_THAT(unknown.error, HasSubstr("have no sensor s9"));
  EXPECT_THAT(with("s1,s2=9").error, HasSubstr("s1 and s2 are 9.00 m apart by --distance and "));
}

TEST(FuseCommand, SaysHowWellTheWalkPlacedTheSensors) {
  const Cell cell(4.0);
  const Outcome done = run_chorus({"fuse", cell.recordings(), "--out", "-", "--json"});
  const Json registration = Json::parse(done.error).at("registration");
  ASSERT_EQ(registration.at("sensors").size(), 3U);
  for (const auto& [name, sensor] : registration.at("sensors").items()) {
    if (name == registration.at("master")) {
      EXPECT_FALSE(sensor.contains("presentRadius")) << "the master is where it is by definition";
    } else {
      EXPECT_GT(sensor.at("presentRadius").get<double>(), 0.0) << name;
    }
  }
}

TEST(FuseCommand, SaysWhatIsSmoothed) {
  const Cell cell(4.0);
  const auto by = [&](const char* method) {
    return run_chorus({"fuse", cell.recordings(), "--smooth", "--method", method, "--out", "-"})
        .error;
  };
  EXPECT_THAT(by("body-filter"), HasSubstr("method body-filter, smoothed, "));
  EXPECT_THAT(by("otto"), HasSubstr("left and right smoothed, places as without --smooth"));
}

TEST(FuseCommand, TheResultAndThePlacesNeedAFileEach) {
  const Cell cell(2.0);
  const std::string out = cell.file("both.ndjson");
  const Outcome both = run_chorus(
      {"fuse", cell.recordings(), "--out", out, "--save-registration", cell.file("./both.ndjson")});
  EXPECT_EQ(both.code, kExitFailed);
  EXPECT_THAT(both.error, HasSubstr("--save-registration"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(FuseCommand, OptionsThatContradictEachOtherAreRefused) {
  const Cell cell(2.0);
  const Outcome both = run_chorus({"fuse", cell.recordings(), "--out", "-", "--from-walk",
                                   "--registration", cell.file("places.json")});
  EXPECT_EQ(both.code, kExitUsage);
  EXPECT_THAT(both.error, HasSubstr("--registration"));
}

TEST(FuseCommand, SaysByWhichMethodAndHowOftenASecond) {
  const Cell cell(3.0);
  const Outcome done = run_chorus({"fuse", cell.recordings(), "--out", "-", "--set",
                                   "fusion.method=otto", "--method", "mean", "--json"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_EQ(Json::parse(done.error).at("method"), "mean");
  EXPECT_EQ(Json::parse(done.error).at("rateHz"), 30.0);
  EXPECT_THAT(run_chorus({"fuse", cell.recordings(), "--out", "-"}).error,
              HasSubstr("method body-filter, 30 instants a second"));
}

TEST(FuseCommand, NamesWhatItCannotUse) {
  const Cell cell(2.0);
  const std::string nonsense = cell.file("nonsense.json");
  std::ofstream(nonsense) << "{\"sensors\": 3";
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"fuse", cell.file("nothing"), "--out", "-"},
           {"fuse", cell.recordings(), "--out", "-", "--registration", cell.file("none.json")},
           {"fuse", cell.recordings(), "--out", "-", "--registration", nonsense},
           {"fuse", cell.recordings(), "--out", "-", "--config", nonsense},
           {"fuse", cell.recordings(), "--out", cell.file("no/such/folder.ndjson")}}) {
    const Outcome done = run_chorus(words);
    EXPECT_EQ(done.code, kExitFailed) << words.back();
    EXPECT_THAT(done.error, HasSubstr("chorus"));
    EXPECT_THAT(done.error, Not(HasSubstr("std::")));
    EXPECT_EQ(done.out, "");
  }
}

TEST(FuseCommand, SensorsThatSawNothingTogetherAreSaidToHave) {
  const Cell cell(2.0);
  auto later = walk_seen_by(1, 2.0);
  for (SensorFrame& frame : later.frames) {
    frame.captured += std::chrono::hours(1);
    for (BodyFrame& body : frame.bodies) body.captured = frame.captured;
  }
  std::filesystem::create_directory(cell.file("apart"));
  ASSERT_THAT(record::write_frame_recording(cell.file("apart/s1.mcap"), walk_seen_by(0, 2.0)),
              chorus::testing::IsOk());
  ASSERT_THAT(record::write_frame_recording(cell.file("apart/s2.mcap"), later),
              chorus::testing::IsOk());
  const Outcome done = run_chorus({"fuse", cell.file("apart"), "--out", cell.file("x.ndjson")});
  EXPECT_THAT(done.error, HasSubstr("never saw the person together"));
}

}  // namespace
}  // namespace chorus::ctl
