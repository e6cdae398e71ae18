#include "common/record/cell_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/cell_writer.h"
#include "common/record/frame_recording.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::record {
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
  auto writer = CellWriter::create(file, {}).value();
  for (const int i : {0, 1, 2, 1, 3}) {
    auto frame = std::make_shared<resource::FrameResource>();
    frame->sequence = static_cast<std::uint64_t>(i) + 1;
    frame->captured = kStart + kFrameInterval * i;
    frame->source = "s1";
    EXPECT_THAT(
        writer.write(RawFrame{chorus::testing::sensor_id("s1"), frame, frame->captured, {}, {}}),
        IsOk());
  }
  EXPECT_THAT(writer.close(), IsOk());
  return file;
}

TEST(NotesOfRecordings, TellWhatWasDamagedAndLeftOut) {
  const TemporaryFolder folder;
  const auto file = walk_in(folder);
  const std::string bytes = bytes_of(file);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes.substr(0, bytes.size() - 30);
  const auto cell = read_cell(file);
  ASSERT_THAT(cell, IsOk());
  EXPECT_THAT(notes_of(*cell), ElementsAre(HasSubstr("walk.mcap: the end is missing"),
                                           HasSubstr("s1: left out 1 frame whose capture time")));
}

TEST(NotesOfRecordings, SayNothingOfAWholeRecording) {
  const TemporaryFolder folder;
  FrameRecording recording;
  recording.sensor = chorus::testing::sensor_id("s1");
  recording.frames = {chorus::testing::sensor_frame("s1", kStart, {})};
  ASSERT_THAT(write_frame_recording(folder / "a.mcap", recording), IsOk());
  const auto cell = read_cell(folder / "a.mcap");
  ASSERT_THAT(cell, IsOk());
  EXPECT_TRUE(notes_of(*cell).empty());
}

}  // namespace
}  // namespace chorus::record
