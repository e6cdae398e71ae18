// What `fuse` and `replay` find in recordings before they read them through.
#include "services/ctl/record/recorded_cell.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::sensor_id;
using chorus::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<fs::path> files_of(const Cell& cell) {
  std::vector<fs::path> files;
  for (const char* name : {"s1", "s2", "s3"})
    files.push_back(fs::path(cell.recordings()) / (std::string(name) + ".mcap"));
  return files;
}

TEST(RegistrationBeside, IsTheOneOfTheRecordingsFolder) {
  const TemporaryFolder folder;
  const auto found = [&] { return registration_beside({folder / "a.mcap", folder / "b.mcap"}); };
  ASSERT_THAT(found(), IsOk());
  EXPECT_FALSE(found()->has_value());
  fs::create_directory(folder / "registration.json");
  EXPECT_FALSE(found()->has_value()) << "a folder is none";
  fs::remove(folder / "registration.json");
  const auto file = folder.write("registration.json", "{}");
  EXPECT_EQ(**found(), file) << "of both recordings, and once";
}

TEST(RegistrationBeside, TwoAreAChoiceThatWeDoNotMake) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "one");
  fs::create_directory(folder / "two");
  (void)folder.write("one/registration.json", "{}");
  const std::vector<fs::path> recordings{folder / "one/a.mcap", folder / "two/b.mcap"};
  EXPECT_EQ(**registration_beside(recordings), folder / "one/registration.json");
  (void)folder.write("two/registration.json", "{}");
  const auto two = registration_beside(recordings);
  ASSERT_THAT(two, FailsWith(ErrorCode::Conflict));
  const std::string told = to_string(two.error());
  EXPECT_THAT(told, HasSubstr((folder / "one/registration.json").string()));
  EXPECT_THAT(told, HasSubstr((folder / "two/registration.json").string()));
  EXPECT_THAT(told, HasSubstr("--registration"));
  EXPECT_THAT(told, HasSubstr("--from-walk"));
}

TEST(RecordedCell, KnowsItsSensorsBeforeItIsRead) {
  const Cell cell(0.5);
  const auto recorded = RecordedCell::open(files_of(cell));
  ASSERT_THAT(recorded, IsOk());
  EXPECT_THAT(recorded->sensors(), ElementsAre(sensor_id("s1"), sensor_id("s2"), sensor_id("s3")));
  ASSERT_THAT(recorded->registration(), IsOk());
  EXPECT_FALSE(recorded->registration()->has_value()) << "sensors alone know no places";
}

TEST(RecordedCell, ReadsEachSensorToItsEndAndAgainFromTheBeginning) {
  const Cell cell(0.5);
  auto recorded = RecordedCell::open(files_of(cell));
  ASSERT_THAT(recorded, IsOk());
  for (int time = 0; time < 2; ++time) {
    const pipeline::OfflineInput input = recorded->input();
    ASSERT_EQ(input.lanes.size(), 3u);
    EXPECT_EQ(input.sensors.size(), 3u);
    for (const auto& lane : input.lanes) {
      std::size_t frames = 0;
      std::set<SensorId> sensors;
      for (auto frame = lane.next(); frame && *frame; frame = lane.next()) {
        ++frames;
        sensors.insert((*frame)->sensor);
      }
      EXPECT_EQ(frames, 15u) << "half a second at 30 Hz, for the time number " << time;
      EXPECT_EQ(sensors.size(), 1u) << "a sensor in each file";
    }
    const RecordedCell::Told told = recorded->told();
    EXPECT_EQ(told.sensors, 3u);
    EXPECT_THAT(told.notes, IsEmpty());
  }
}

/// An imported recording of one frame.
fs::path imported(const chorus::testing::TemporaryFolder& folder, const char* sensor,
                  const char* clocks, const char* set) {
  record::FrameRecording recording;
  recording.sensor = sensor_id(sensor);
  recording.notes = {{"set_origin", to_iso8601(chorus::testing::kStart)},
                     {"set_period_ns", "1000000000"},
                     {"clocks", clocks},
                     {"set", set}};
  recording.frames = {chorus::testing::sensor_frame(sensor, chorus::testing::kStart, {})};
  const fs::path file = folder / (std::string(sensor) + ".mcap");
  EXPECT_TRUE(record::write_frame_recording(file, recording));
  return file;
}

std::vector<double> clock_sigmas(RecordedCell& cell) {
  std::vector<double> sigmas;
  for (const auto& lane : cell.input().lanes) {
    const auto frame = lane.next();
    sigmas.push_back(frame && *frame ? (*frame)->clock_sigma : -1.0);
  }
  return sigmas;
}

TEST(RecordedCell, ClocksAreWhatTheImportSaidAndSeparateImportsHaveSeparateOnes) {
  const chorus::testing::TemporaryFolder folder;
  auto cell = RecordedCell::open(
      {imported(folder, "s1", "one", "a"), imported(folder, "s2", "own", "a"),
       imported(folder, "s3", "unknown", "a"), imported(folder, "s4", "one", "b")});
  ASSERT_THAT(cell, IsOk());
  EXPECT_THAT(clock_sigmas(*cell), ElementsAre(0.0, 0.1, kUnknownClock, kUnknownClock));
  cell->drop_clock_claims();
  EXPECT_THAT(clock_sigmas(*cell), ::testing::Each(kUnknownClock));
}

TEST(RecordedCell, TellsWhatADamagedEndHasLost) {
  const Cell cell(0.5);
  const auto files = files_of(cell);
  fs::resize_file(files[1], fs::file_size(files[1]) * 3 / 4);
  auto recorded = RecordedCell::open(files);
  ASSERT_THAT(recorded, IsOk());
  const pipeline::OfflineInput input = recorded->input();
  for (const auto& lane : input.lanes) {
    for (auto frame = lane.next(); frame && *frame; frame = lane.next()) {
    }
  }
  EXPECT_EQ(recorded->sensors().size(), 3u) << "the whole ones are of use all the same";
  const auto notes = recorded->told().notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], HasSubstr("s2.mcap"));
}

TEST(RecordedCell, WhatIsNoRecordingIsNamed) {
  const TemporaryFolder folder;
  const auto none = RecordedCell::open({folder / "none.mcap"});
  ASSERT_FALSE(none);
  EXPECT_THAT(to_string(none.error()), HasSubstr("none.mcap"));
  const auto text = RecordedCell::open({folder.write("text.mcap", "no recording at all")});
  ASSERT_FALSE(text);
  EXPECT_THAT(to_string(text.error()), HasSubstr("text.mcap"));
}

}  // namespace
}  // namespace chorus::ctl
