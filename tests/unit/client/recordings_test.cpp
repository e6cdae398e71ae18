#include "fusion-server/client/recordings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "common/record/cell_writer.h"
#include "common/record/frame_recording.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::client {
namespace {

using chorus::testing::bytes_of;
using chorus::testing::IsOk;
using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using chorus::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path walk_in(const TemporaryFolder& folder) {
  const auto file = folder / "walk.mcap";
  auto writer = record::CellWriter::create(file, {}).value();
  for (const int i : {0, 1, 2, 1, 3}) {
    auto frame = std::make_shared<resource::FrameResource>();
    frame->sequence = static_cast<std::uint64_t>(i) + 1;
    frame->captured = kStart + kFrameInterval * i;
    frame->source = "s1";
    EXPECT_THAT(writer.write(record::RawFrame{
                    chorus::testing::sensor_id("s1"), frame, frame->captured, {}, {}}),
                IsOk());
  }
  EXPECT_THAT(writer.close(), IsOk());
  return file;
}

TEST(ReadRecordings, TellWhatWasDamagedAndLeftOut) {
  const TemporaryFolder folder;
  const auto file = walk_in(folder);
  const std::string bytes = bytes_of(file);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes.substr(0, bytes.size() - 30);
  std::ostringstream told;
  const auto cell = read_recordings({file}, &told);
  ASSERT_THAT(cell, IsOk());
  EXPECT_THAT(told.str(), HasSubstr("note: walk.mcap: the end is missing"));
  EXPECT_THAT(told.str(), HasSubstr("note: s1: left out 1 frame whose capture time"));
  EXPECT_THAT(notes_of(*cell),
              ElementsAre(HasSubstr("the end is missing"), HasSubstr("left out 1")));
}

TEST(ReadRecordings, SayNothingOfAWholeRecording) {
  const TemporaryFolder folder;
  record::FrameRecording recording;
  recording.sensor = chorus::testing::sensor_id("s1");
  recording.frames = {chorus::testing::sensor_frame("s1", kStart, {})};
  ASSERT_THAT(record::write_frame_recording(folder / "a.mcap", recording), IsOk());
  std::ostringstream told;
  ASSERT_THAT(read_recordings({folder / "a.mcap"}, &told), IsOk());
  EXPECT_EQ(told.str(), "");
}

}  // namespace
}  // namespace chorus::client
