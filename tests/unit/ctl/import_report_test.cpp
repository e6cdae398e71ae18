// What `chorus import` says of what it has written, and what it never writes over.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/importers/formats.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using chorus::testing::bytes_of;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using Json = nlohmann::json;

/// A head that moves for a second and a half at 2 Hz.
constexpr const char* kTable =
    "time_s,joint,x_m,y_m,z_m\n0,Head,0,1.6,2\n0.5,Head,0.1,1.6,2\n1.5,Head,0.2,1.6,2\n";

class ImportReport : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name, const std::string& text = kTable) const {
    return folder_.write(name, text).string();
  }
  [[nodiscard]] std::string out(const std::string& name = "") const {
    return (folder_ / ("rec" + (name.empty() ? "" : "/" + name))).string();
  }
  [[nodiscard]] Outcome import(std::vector<std::string> inputs,
                               const std::vector<std::string>& more = {}) const {
    inputs.insert(inputs.begin(), {"import", "csv"});
    inputs.insert(inputs.end(), {"--out", out()});
    inputs.insert(inputs.end(), more.begin(), more.end());
    return run_chorus(inputs);
  }
  chorus::testing::TemporaryFolder folder_;
};

TEST_F(ImportReport, IsATableAndTheFilesThatWereWritten) {
  const Outcome done = import({file("left.csv")}, {"--start", "2026-11-21T07:30:00Z"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  const auto lines = lines_of(done.out);
  ASSERT_GE(lines.size(), 3u);
  EXPECT_THAT(lines[0], MatchesRegex("sensor +frames +seconds +first capture +device"));
  EXPECT_THAT(lines[1], MatchesRegex("left +3 +1\\.50 +2026-11-21T07:30:00\\.000000000Z +.*"));
  EXPECT_THAT(done.out, HasSubstr("\nwrote " + out("left.mcap") + "\n"));
  EXPECT_THAT(done.out, HasSubstr("\nwrote " + out("registration.json") + "\n"));
  for (const char* written : {"left.mcap", "registration.json"})
    EXPECT_TRUE(fs::exists(out(written))) << written;
}

TEST_F(ImportReport, TellsTheSameAsJson) {
  const Outcome done = import({file("left.csv")}, {"--start", "2026-11-21T07:30:00Z", "--json"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  const Json json = Json::parse(done.out);
  std::vector<std::string> files = json.at("files");
  EXPECT_EQ(files.front(), out("left.mcap"));
  for (const std::string& each : files) EXPECT_TRUE(fs::exists(each)) << each;
  const Json& recording = json.at("recordings").at(0);
  EXPECT_EQ(recording.at("sensor"), "left");
  EXPECT_EQ(recording.at("frames"), 3);
  EXPECT_EQ(recording.at("first"), "2026-11-21T07:30:00.000000000Z");
  EXPECT_EQ(recording.at("last"), "2026-11-21T07:30:01.500000000Z");
  EXPECT_EQ(recording.at("notes").at("origin"), "left.csv");
}

TEST_F(ImportReport, PlacesThatAreTheWorldsOwnAreARegistrationThatCanBeUsed) {
  ASSERT_EQ(import({file("left.csv")}).code, kExitOk);
  const Json places = Json::parse(bytes_of(out("registration.json")));
  EXPECT_EQ(places.at("master"), "left");
  EXPECT_EQ(places.at("verdict"), "Good");
  const Outcome fused = run_chorus({"fuse", out(), "--out", out("fused.ndjson")});
  EXPECT_EQ(fused.code, kExitOk) << fused.error;
}

TEST_F(ImportReport, NameAndStartAreThoseThatAreAskedFor) {
  const Outcome done = import({file("left.csv")}, {"--sensor", "cam7"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_TRUE(fs::exists(out("cam7.mcap")));
  EXPECT_FALSE(fs::exists(out("left.mcap")));
  const auto back = record::read_frame_recording(out("cam7.mcap"));
  ASSERT_THAT(back, chorus::testing::IsOk());
  EXPECT_EQ(back->sensor.str(), "cam7");
  EXPECT_EQ(to_iso8601(back->frames.front().captured), "2020-01-01T00:00:00.000000000Z")
      << "a day that nobody takes for the real one";
}

TEST_F(ImportReport, OneNameForSeveralFilesIsRefused) {
  const Outcome done = import({file("left.csv"), file("right.csv")}, {"--sensor", "cam7"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_FALSE(fs::exists(out("cam7.mcap")));
}

TEST_F(ImportReport, AnEmptyFileIsSaidAndDoesNotStopTheOthers) {
  const Outcome done = import({file("left.csv"), file("none.csv", "")});
  EXPECT_EQ(done.code, kExitFailed) << "not all that was asked for is there";
  EXPECT_THAT(done.error, HasSubstr("none.csv"));
  EXPECT_THAT(done.error, HasSubstr("; the other files were imported\n"));
  EXPECT_TRUE(fs::exists(out("left.mcap")));
  EXPECT_FALSE(fs::exists(out("none.mcap")));
}

TEST_F(ImportReport, WhatMayBeARecordingIsNeverWrittenOver) {
  fs::create_directory(out());
  std::ofstream(out("left.mcap")) << "perhaps a recording whose head is damaged";
  const std::string before = bytes_of(out("left.mcap"));
  const Outcome done = import({file("left.csv")});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("never overwritten. Name another --out or --sensor."));
  EXPECT_EQ(bytes_of(out("left.mcap")), before);
  EXPECT_FALSE(fs::exists(out("registration.json"))) << "nothing is half done";
}

TEST_F(ImportReport, WhatIsNoRegistrationIsNotReplacedByOne) {
  fs::create_directory(out());
  std::ofstream(out("registration.json")) << "somebody's notes";
  const Outcome done = import({file("left.csv")});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("is there, and is no registration. Name another --out."));
  EXPECT_EQ(bytes_of(out("registration.json")), "somebody's notes");
}

TEST_F(ImportReport, AFormatThatIsNoneIsAnsweredWithAllThereAre) {
  const Outcome done = run_chorus({"import", "fbx", "x", "--out", out()});
  EXPECT_EQ(done.code, kExitUsage);
  EXPECT_THAT(done.error, HasSubstr("there is no format \"fbx\""));
  for (const char* name : {"video", "openpose", "mmpose"}) EXPECT_THAT(done.error, HasSubstr(name));
  for (const auto& row : importers::kFormats)
    EXPECT_THAT(done.error, HasSubstr(std::string(row.name)));
}

TEST_F(ImportReport, OptionsOfCamerasAreForCameras) {
  const Outcome lens = import({file("left.csv")}, {"--intrinsics", "lens.json"});
  EXPECT_EQ(lens.code, kExitFailed);
  EXPECT_THAT(lens.error, HasSubstr("--intrinsics: is for cameras; leave it out"));
  for (const char* rate : {"0", "1001", "nan"}) {
    const Outcome told = run_chorus({"import", "openpose", "x", "--out", out(), "--rate", rate});
    EXPECT_EQ(told.code, kExitUsage) << rate;
  }
}

TEST_F(ImportReport, SeveralFloorsAfterOneOptionAreNoInputs) {
  const Outcome told = run_chorus({"import", "csv", file("a.csv"), file("b.csv"), "--out", out(),
                                   "--floor", "0,1,0,1.4", "0,1,0,1.2"});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("say --floor before each: --floor 0,1,0,1.2"));
}

TEST_F(ImportReport, AnImportMayBeRepeated) {
  const std::string left = file("left.csv");
  ASSERT_EQ(import({left}).code, kExitOk);
  const Outcome again = import({left}, {"--start", "2026-11-21T07:30:00Z"});
  EXPECT_EQ(again.code, kExitOk) << again.error;
  EXPECT_THAT(again.error, Not(HasSubstr("was there before"))) << "it is this one's own";
  const auto back = record::read_frame_recording(out("left.mcap"));
  ASSERT_THAT(back, chorus::testing::IsOk());
  EXPECT_EQ(to_iso8601(back->frames.front().captured), "2026-11-21T07:30:00.000000000Z");
}

}  // namespace
}  // namespace chorus::ctl
