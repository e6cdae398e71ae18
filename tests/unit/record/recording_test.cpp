#include "common/record/recording.h"

#include <sys/resource.h>

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace chorus::record {
namespace {

using chorus::testing::TemporaryFolder;
using std::chrono::milliseconds;

constexpr std::int64_t kRecordingStart = 1'700'000'000'000'000'000;  // [ns], an arbitrary UTC

Message message_at(int index, std::string data) {
  const Timestamp t = from_unix_ns(kRecordingStart) + milliseconds(33) * index;
  return {"", static_cast<std::uint32_t>(index), t, t - milliseconds(2), std::move(data)};
}

const Channel kFrames{"/frame", "chorus.Frame", R"({"type":"object"})", {{"unit", "m"}}};

TEST(Recording, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "a.mcap");
  ASSERT_TRUE(writer);
  const auto frames = writer->add_channel(kFrames);
  const auto plain = writer->add_channel({"/notes", "", "", {}});
  ASSERT_TRUE(frames && plain);
  ASSERT_TRUE(writer->write_metadata("chorus", {{"sensor", "s1"}}));
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(writer->write(*frames, message_at(i, "{\"n\":" + std::to_string(i) + "}")));
  }
  ASSERT_TRUE(writer->write(*plain, message_at(50, "\"half\"")));
  ASSERT_TRUE(writer->close());

  const auto read = read_recording(folder / "a.mcap");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_FALSE(read->truncated);
  EXPECT_THAT(read->notes, ::testing::IsEmpty());
  ASSERT_EQ(read->messages.size(), 101u);
  EXPECT_EQ(read->messages[7].topic, "/frame");
  EXPECT_EQ(read->messages[7].data, "{\"n\":7}");
  EXPECT_EQ(read->messages[7].sequence, 7u);
  EXPECT_EQ(read->messages[7].log_time, message_at(7, "").log_time);
  EXPECT_EQ(read->messages[7].publish_time, message_at(7, "").publish_time);
  EXPECT_EQ(read->messages[51].topic, "/notes") << "same time: in the order of the file";
  ASSERT_EQ(read->channels.size(), 2u);
  EXPECT_EQ(read->channels[0].schema_name, "chorus.Frame");
  EXPECT_EQ(read->channels[0].schema_json, kFrames.schema_json);
  EXPECT_EQ(read->channels[0].metadata, kFrames.metadata);
  EXPECT_EQ(read->metadata.at("chorus").at("sensor"), "s1");
}

TEST(Recording, UnsortedMessagesAreSortedStably) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "a.mcap");
  const auto channel = writer->add_channel(kFrames);
  for (const int i : {5, 1, 3, 1}) ASSERT_TRUE(writer->write(*channel, message_at(i, "")));
  ASSERT_TRUE(writer->write(*channel, message_at(1, "last")));
  ASSERT_TRUE(writer->close());
  const auto read = read_recording(folder / "a.mcap");
  ASSERT_TRUE(read);
  std::vector<std::uint32_t> order;
  for (const Message& m : read->messages) order.push_back(m.sequence);
  EXPECT_THAT(order, ::testing::ElementsAre(1, 1, 1, 3, 5));
  EXPECT_EQ(read->messages[2].data, "last");
}

TEST(Recording, AnEmptyOneIsAValidFile) {
  const TemporaryFolder folder;
  ASSERT_TRUE(RecordingWriter::create(folder / "a.mcap")->close());
  const auto read = read_recording(folder / "a.mcap");
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->truncated);
  EXPECT_TRUE(read->messages.empty());
}

TEST(Recording, IsCompressed) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "a.mcap");
  const auto channel = writer->add_channel(kFrames);
  constexpr int kCount = 100;
  const std::string body(1000, 'x');
  for (int i = 0; i < kCount; ++i) ASSERT_TRUE(writer->write(*channel, message_at(i, body)));
  ASSERT_TRUE(writer->close());
  EXPECT_LT(std::filesystem::file_size(folder / "a.mcap"), kCount * body.size() / 2);
}

TEST(Recording, AClosedChunkIsInTheFileBeforeClose) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "a.mcap");
  const auto channel = writer->add_channel(kFrames);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(writer->write(*channel, message_at(i, "{}")));
  const auto read = read_recording(folder / "a.mcap");  // what a kill -9 would leave at this time
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->truncated);
  EXPECT_EQ(read->messages.size(), 93u) << "three chunks of one second, 31 frames each";
}

TEST(RecordingWriter, NeverOverwrites) {
  const TemporaryFolder folder;
  ASSERT_TRUE(RecordingWriter::create(folder / "a.mcap"));
  const auto again = RecordingWriter::create(folder / "a.mcap");
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, ErrorCode::Conflict);
}

TEST(RecordingWriter, RefusesWhatItCannotRecord) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "a.mcap");
  EXPECT_FALSE(writer->add_channel({}));
  EXPECT_FALSE(writer->write(1, message_at(0, ""))) << "no such channel";
  const auto channel = writer->add_channel(kFrames);
  EXPECT_FALSE(writer->write(0, message_at(0, "")));
  EXPECT_FALSE(writer->write(*channel, {"", 0, from_unix_ns(-1), from_unix_ns(-1), ""}));
  EXPECT_EQ(writer->write(*channel, message_at(0, std::string((32u << 20) + 1, ' '))).error().code,
            ErrorCode::TooLarge);
  ASSERT_TRUE(writer->close());
  EXPECT_TRUE(writer->close()) << "closing twice is harmless";
  EXPECT_EQ(writer->write(*channel, message_at(0, "")).error().code, ErrorCode::Conflict);
}

TEST(RecordingWriter, AFullDiskIsReportedAndWhatWasWrittenStaysReadable) {
  const TemporaryFolder folder;
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 20'000;
  setrlimit(RLIMIT_FSIZE, &small);
  auto writer = RecordingWriter::create(folder / "a.mcap", {.chunk_bytes = 2000});
  const auto channel = writer->add_channel(kFrames);
  std::string body(1000, '\0');
  Result<void> ok;
  int written = 0;
  for (; ok && written < 1000; ++written) {
    for (char& c : body) c = static_cast<char>(std::rand());  // not compressible
    ok = writer->write(*channel, message_at(written, body));
  }
  setrlimit(RLIMIT_FSIZE, &before);
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().code, ErrorCode::Io);
  EXPECT_FALSE(writer->close()) << "the error is repeated, not forgotten";
  const auto read = read_recording(folder / "a.mcap");
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->truncated);
  EXPECT_GT(read->messages.size(), 10u);
}

}  // namespace
}  // namespace chorus::record
