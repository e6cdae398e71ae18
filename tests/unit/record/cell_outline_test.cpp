// Describes a cell's recording without reading it whole, and reads it without holding it in memory.
#include "common/record/cell_outline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/cell_stream.h"
#include "tests/support/builders.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/record/cell_rig.h"

namespace chorus::record {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using chorus::testing::TemporaryFolder;
using std::chrono::milliseconds;
using ::testing::SizeIs;

resource::FrameResource frame_of(const char* source, int i) {
  resource::FrameResource frame;
  frame.sequence = static_cast<std::uint64_t>(i) + 1;
  frame.captured = kStart + kFrameInterval * i;
  frame.source = source;
  return frame;
}

std::shared_ptr<const resource::FrameResource> outline_seen_by(const char* sensor, int i) {
  return std::make_shared<const resource::FrameResource>(frame_of(sensor, i));
}

FusedFrame outline_fused(int i) {
  const Timestamp t = kStart + kFrameInterval * i;
  return {t, t + milliseconds(20), [i] {
            resource::FrameResource frame = frame_of("fusion", i);
            frame.space = resource::SpaceKind::World;
            return frame;
          }};
}

void write_outlined_cell(const std::filesystem::path& path) {
  write_cell(path, {kStart, R"({"version":1,"sensors":{}})", {}}, outline_seen_by, outline_fused);
}

TEST(CellOutline, TellsWhoWasThereAndWhenWithoutReadingItThrough) {
  const TemporaryFolder folder;
  write_outlined_cell(folder / "a.mcap");
  const auto lines = cell_lines({folder / "a.mcap"});
  ASSERT_TRUE(lines) << to_string(lines.error());
  ASSERT_THAT(*lines, SizeIs(1));
  EXPECT_TRUE(lines->front().cell);
  const auto stays = sensor_stays(*lines);
  ASSERT_TRUE(stays) << to_string(stays.error());
  ASSERT_THAT(*stays, SizeIs(2));
  const SensorStay& second = stays->back();
  EXPECT_EQ(second.about.sensor.str(), "s2");
  EXPECT_EQ(second.frames, 40u);
  EXPECT_EQ(second.first, kStart + milliseconds(400)) << "by the first clock model";
  EXPECT_EQ(second.last, kStart + kFrameInterval * 39 + milliseconds(410)) << "by the last";
  EXPECT_EQ(last_registration(*lines).value(), R"({"version":1,"sensors":{}})");
}

/// s1 is well; s2 gives for an answer what it saw minutes ago, and after a second `later` frames.
void write_cell_with_left_over(const std::filesystem::path& path, int later) {
  auto writer = CellWriter::create(path, {});
  ASSERT_TRUE(writer);
  RawFrame old = raw_frame("s2", outline_seen_by("s2", -9000));
  old.received = kStart;
  ASSERT_TRUE(writer->write(old));
  for (int i = 0; i < kCellFrames; ++i) {
    ASSERT_TRUE(writer->write(raw_frame("s1", outline_seen_by("s1", i))));
    if (i < kCellFrames - later) continue;
    ASSERT_TRUE(writer->write(raw_frame("s2", outline_seen_by("s2", i))));
  }
  ASSERT_TRUE(writer->close());
}

TEST(CellOutline, BeginsWithoutWhatADeadSensorHadLeftOver) {
  const TemporaryFolder folder;
  write_cell_with_left_over(folder / "back.mcap", 10);
  const auto back = sensor_stays(cell_lines({folder / "back.mcap"}).value());
  ASSERT_TRUE(back);
  ASSERT_THAT(*back, SizeIs(2));
  EXPECT_FALSE(back->front().left_over);
  EXPECT_TRUE(back->back().left_over);
  EXPECT_EQ(back->back().first, kStart + kFrameInterval * (kCellFrames - 10));
  EXPECT_EQ(back->back().frames, 10u);

  write_cell_with_left_over(folder / "dead.mcap", 0);
  const auto dead = sensor_stays(cell_lines({folder / "dead.mcap"}).value());
  ASSERT_TRUE(dead);
  ASSERT_THAT(*dead, SizeIs(1)) << "s2 was not there";
  EXPECT_EQ(dead->front().about.sensor.str(), "s1");
}

TEST(CellOutline, ASensorWhoseClockIsWrongHasLeftNothingOver) {
  const TemporaryFolder folder;
  auto writer = CellWriter::create(folder / "a.mcap", {});
  ASSERT_TRUE(writer);
  for (int i = 0; i < kCellFrames; ++i) {
    RawFrame behind = raw_frame("s1", outline_seen_by("s1", i));
    behind.received += std::chrono::hours(1);
    ASSERT_TRUE(writer->write(behind));
  }
  ASSERT_TRUE(writer->close());
  const auto stays = sensor_stays(cell_lines({folder / "a.mcap"}).value());
  ASSERT_TRUE(stays);
  ASSERT_THAT(*stays, SizeIs(1));
  EXPECT_EQ(stays->front().first, kStart);
  EXPECT_FALSE(stays->front().left_over);
}

TEST(CellOutline, RefusesTwoRecordingsOfOneSensor) {
  const TemporaryFolder folder;
  write_outlined_cell(folder / "a.mcap");
  write_outlined_cell(folder / "b.mcap");
  const auto lines = cell_lines({folder / "a.mcap", folder / "b.mcap"});
  ASSERT_TRUE(lines);
  ASSERT_THAT(*lines, SizeIs(2)) << "neither says that it is a part of the other";
  const auto stays = sensor_stays(*lines);
  ASSERT_FALSE(stays);
  EXPECT_EQ(stays.error().code, ErrorCode::Conflict);
}

TEST(CellStream, GivesWhatReadingItWholeGives) {
  const TemporaryFolder folder;
  write_outlined_cell(folder / "a.mcap");
  const auto whole = read_cell(folder / "a.mcap", {.fused = true});
  ASSERT_TRUE(whole);
  CellStream stream({folder / "a.mcap"}, {.fused = true});
  std::map<std::string, std::size_t> frames;
  Timestamp last_s1{};
  for (auto item = stream.next(); item && *item; item = stream.next()) {
    if (const auto* frame = std::get_if<SensorFrame>(&**item)) {
      const std::string sensor = frame->sensor.str();
      const auto& same = whole->sensors[sensor == "s1" ? 0 : 1].frames[frames[sensor]++];
      EXPECT_EQ(frame->captured, same.captured);
      EXPECT_EQ(frame->floor, same.floor);
      if (sensor == "s1") last_s1 = frame->captured;
    }
    if (std::holds_alternative<resource::FrameResource>(**item)) ++frames["fused"];
  }
  EXPECT_EQ(frames["s1"], 40u);
  EXPECT_EQ(frames["s2"], 40u);
  EXPECT_EQ(frames["fused"], 40u);
  EXPECT_EQ(last_s1, kStart + kFrameInterval * 39);
  EXPECT_THAT(stream.finish().sensors, SizeIs(2));
}

}  // namespace
}  // namespace chorus::record
