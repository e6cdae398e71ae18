// What `chorus replay` and `chorus record` refuse before anything is started or written.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "common/http/client.h"
#include "common/record/cell_writer.h"
#include "tests/unit/ctl/program_run.h"
#include "tests/unit/ctl/scripted_server.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;

TEST(ReplayCommand, NeedsRecordings) {
  const chorus::testing::TemporaryFolder folder;
  for (const std::string& path : {folder.path().string(), (folder / "no.mcap").string()}) {
    const Outcome told = run_chorus({"replay", path});
    EXPECT_EQ(told.code, kExitFailed);
    EXPECT_THAT(told.error, HasSubstr(path));
  }
  EXPECT_EQ(run_chorus({"replay"}).code, kExitUsage);
}

TEST(ReplayCommand, NeedsAPortForEverySensor) {
  const Cell cell(0.5);
  const Outcome told = run_chorus({"replay", cell.recordings(), "--port", "65534"});
  EXPECT_EQ(told.code, kExitFailed) << "three sensors";
  EXPECT_THAT(told.error, HasSubstr("--port"));
  EXPECT_EQ(told.out, "") << "half a cell is not started";
}

TEST(ReplayCommand, NamesItsOwnOptionForAPortThatIsTaken) {
  const Cell cell(0.5);
  const ScriptedServer other(ScriptedServer::Texts{});
  const std::string port = std::to_string(http::parse_url(other.url()).value().port);
  const Outcome told = run_chorus({"replay", cell.recordings() + "/s1.mcap", "--port", port});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("set --port to a port that is free"));
  EXPECT_EQ(told.out, "") << "nothing plays";
}

TEST(ReplayCommand, RefusesSpeedsAndPortsThatAreNone) {
  for (const auto& [option, value] :
       std::vector<std::pair<std::string, std::string>>{{"--speed", "0"},
                                                        {"--speed", "fast"},
                                                        {"--speed", "nan"},
                                                        {"--port", "0"},
                                                        {"--port", "65536"}}) {
    const Outcome told = run_chorus({"replay", "x.mcap", option, value});
    EXPECT_EQ(told.code, kExitUsage) << value;
    EXPECT_THAT(told.error, HasSubstr(option));
  }
}

TEST(ReplayCommand, WritesItsRegistrationOverNoRecording) {
  const Cell cell(0.5);
  const std::string recording = cell.recordings() + "/s1.mcap";
  const auto size = std::filesystem::file_size(recording);
  const Outcome told = run_chorus({"replay", cell.recordings(), "--save-registration", recording});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("s1.mcap"));
  EXPECT_EQ(std::filesystem::file_size(recording), size);
}

TEST(ReplayCommand, OneSensorTwiceIsRefused) {
  const Cell cell(0.5);
  std::filesystem::create_directory(cell.file("again"));
  std::filesystem::copy_file(cell.recordings() + "/s1.mcap", cell.file("again") + "/s1.mcap");
  const Outcome told = run_chorus({"replay", cell.recordings(), cell.file("again")});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("s1"));
  EXPECT_EQ(told.out, "");
}

TEST(ReplayCommand, FusedFramesAloneCannotBePlayed) {
  const chorus::testing::TemporaryFolder folder;
  auto writer = record::CellWriter::create(folder / "fused.mcap", {});
  ASSERT_TRUE(writer);
  for (int i = 0; i < 3; ++i) {
    const Timestamp t = chorus::testing::kStart + chorus::testing::kFrameInterval * i;
    ASSERT_TRUE(writer->write(record::FusedFrame{t, t, [t] {
                                                   resource::FrameResource frame;
                                                   frame.captured = t;
                                                   frame.source = "fusion";
                                                   frame.space = resource::SpaceKind::World;
                                                   return frame;
                                                 }}));
  }
  ASSERT_TRUE(writer->close());
  const Outcome told = run_chorus({"replay", (folder / "fused.mcap").string()});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("hold no frames of a sensor"));
}

TEST(RecordCommand, NeverWritesOverAFile) {
  const chorus::testing::TemporaryFolder folder;
  const std::string file = (folder / "a.mcap").string();
  std::ofstream(file) << "precious";
  const ScriptedServer server(
      ScriptedServer::Texts{{"/", {R"({"@type": ["Tracker"]})"}}, {"/sensors/", {"{}"}}});
  const Outcome told = run_chorus({"record", server.url(), "--out", file, "--seconds", "1"});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr(file));
  EXPECT_THAT(told.error, HasSubstr("exists already, and a recording is never overwritten"));
  EXPECT_EQ(std::filesystem::file_size(file), 8u);
}

TEST(RecordCommand, WithoutAFrameLeavesNoFileSoThatItCanBeTriedAgain) {
  const chorus::testing::TemporaryFolder folder;
  const std::string file = (folder / "a.mcap").string();
  const ScriptedServer server(
      ScriptedServer::Texts{{"/", {R"({"@type": ["Tracker"]})"}}, {"/sensors/", {"{}"}}});
  for (int attempt = 0; attempt < 2; ++attempt) {
    const Outcome told = run_chorus({"record", server.url(), "--out", file, "--seconds", "1"});
    EXPECT_EQ(told.code, kExitFailed);
    EXPECT_THAT(told.error, HasSubstr("delivered no frame in this time"));
    EXPECT_FALSE(std::filesystem::exists(file));
  }
}

TEST(RecordCommand, NeedsAServiceOfOurs) {
  const chorus::testing::TemporaryFolder folder;
  const std::string out = (folder / "a.mcap").string();
  const std::string gone = ScriptedServer(ScriptedServer::Texts{}).url();
  EXPECT_EQ(run_chorus({"record", gone, "--out", out, "--seconds", "1"}).code, kExitFailed);
  EXPECT_EQ(run_chorus({"record", "ftp://x/", "--out", out}).code, kExitFailed);
  const ScriptedServer stranger(ScriptedServer::Texts{{"/", {R"({"hello": "world"})"}}});
  const Outcome told = run_chorus({"record", stranger.url(), "--out", out, "--seconds", "1"});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("127.0.0.1"));
}

TEST(RecordCommand, ARecordingIsAnMcapFile) {
  const Outcome told =
      run_chorus({"record", "http://127.0.0.1:1/", "--out", "/tmp/walk", "--seconds", "1"});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("name it /tmp/walk.mcap"));
}

TEST(RecordCommand, RefusesTimesThatAreNone) {
  for (const char* seconds : {"0", "-1", "soon", "nan", "1e9"})
    EXPECT_EQ(run_chorus({"record", "--out", "/tmp/x.mcap", "--seconds", seconds}).code, kExitUsage)
        << seconds;
  EXPECT_EQ(run_chorus({"record"}).code, kExitUsage) << "--out is missing";
}

}  // namespace
}  // namespace chorus::ctl
