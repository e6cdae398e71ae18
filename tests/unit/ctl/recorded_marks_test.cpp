// Marks of a recording, for the phases of a task.
#include "services/ctl/evaluate/recorded_marks.h"

#include <gtest/gtest.h>

#include "common/record/marks.h"
#include "common/record/recording.h"
#include "tests/support/builders.h"
#include "tests/support/temporary_folder.h"

namespace chorus::ctl {
namespace {

using chorus::testing::kStart;

/// A recording that begins half a second before its first fused frame, with one mark.
std::string recorded(const chorus::testing::TemporaryFolder& folder) {
  const std::string file = (folder / "walk.mcap").string();
  auto writer = record::RecordingWriter::create(file);
  const auto places = writer->add_channel({"/registration", "chorus.Registration", "{}"});
  const auto marks = writer->add_channel({std::string(record::kMarksTopic), "chorus.Mark", "{}"});
  const Timestamp begin = kStart - std::chrono::milliseconds(500);
  const Timestamp at = kStart + std::chrono::seconds(2);
  EXPECT_TRUE(writer->write(*places, {"", 0, begin, begin, "{}"}));
  EXPECT_TRUE(writer->write(*marks, {"", 0, at, at, record::mark_json({at, "lift"})}));
  EXPECT_TRUE(writer->write(*marks, {"", 0, at, at, "no mark"}));
  EXPECT_TRUE(writer->close());
  return file;
}

TEST(RecordedMarks, CountFromTheFirstFusedFrame) {
  const chorus::testing::TemporaryFolder folder;
  const auto marks = marks_of(recorded(folder), {kStart, 8.0});
  ASSERT_TRUE(marks) << to_string(marks.error());
  EXPECT_EQ(marks->end, 8.0);
  ASSERT_EQ(marks->all.size(), 1U);
  EXPECT_EQ(marks->all[0].name, "lift");
  EXPECT_NEAR(marks->all[0].at, 2.0, 1e-9);
}

TEST(RecordedMarks, BesideTheRecordingCountInstead) {
  const chorus::testing::TemporaryFolder folder;
  const std::string file = recorded(folder);
  folder.write("marks.json", R"([{"id": 1, "seconds": 3.5, "text": "moved"}])");
  const auto marks = marks_of(file, {kStart, 8.0});
  ASSERT_TRUE(marks) << to_string(marks.error());
  ASSERT_EQ(marks->all.size(), 1U);
  EXPECT_EQ(marks->all[0].name, "moved");
  EXPECT_NEAR(marks->all[0].at, 3.0, 1e-9) << "3.5 s after the recording's first message";
  folder.write("marks.json", "[{");
  EXPECT_FALSE(marks_of(file, {kStart, 8.0}));
}

TEST(RecordedMarks, OfOtherSourcesThereAreNone) {
  for (const char* source : {"-", "fused.ndjson", "http://127.0.0.1:8080/"})
    EXPECT_TRUE(marks_of(source, {kStart, 8.0}).value().all.empty()) << source;
}

}  // namespace
}  // namespace chorus::ctl
