// A recording read message by message: in order, in little memory, unpacking only what is needed.
#include "common/record/recording_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include "common/record/mcap_format.h"
#include "tests/support/temporary_folder.h"

namespace chorus::record {
namespace {

using chorus::testing::bytes_of;
using chorus::testing::TemporaryFolder;
using mcap::ByteWriter;
using mcap::Op;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A message of channel 1 ("/a") or 2 ("/b") at a time in seconds.
struct Entry {
  std::uint16_t channel;
  int second;
};

std::uint64_t at(int second) { return static_cast<std::uint64_t>(second) * 1'000'000'000; }

std::string message_record(const Entry& entry) {
  ByteWriter fields;
  fields.u16(entry.channel).u32(static_cast<std::uint32_t>(entry.second));
  fields.u64(at(entry.second)).u64(at(entry.second)).raw("{}");
  return mcap::record(Op::Message, fields.bytes());
}

std::string head_of_file() {
  std::string bytes(mcap::kMagic);
  bytes += mcap::record(Op::Header, ByteWriter().text("").text("test").bytes());
  for (const auto& [id, topic] : {std::pair<std::uint16_t, const char*>{1, "/a"}, {2, "/b"}}) {
    bytes += mcap::record(Op::Channel,
                          ByteWriter().u16(id).u16(0).text(topic).text("json").text("").bytes());
  }
  return bytes;
}

std::string end_of_file() {
  std::string bytes = mcap::record(Op::DataEnd, ByteWriter().u32(0).bytes());
  bytes += mcap::record(Op::Footer, ByteWriter().u64(0).u64(0).u32(0).bytes());
  return bytes + std::string(mcap::kMagic);
}

/// A chunk that correctly states when it begins and ends.
std::string chunk_of(const std::vector<Entry>& entries, std::uint32_t crc = 0) {
  std::string records;
  std::uint64_t first = ~0ull;
  std::uint64_t last = 0;
  for (const Entry& entry : entries) {
    records += message_record(entry);
    first = std::min(first, at(entry.second));
    last = std::max(last, at(entry.second));
  }
  ByteWriter fields;
  fields.u64(first).u64(last).u64(records.size()).u32(crc).text("");
  fields.u64(records.size()).raw(records);
  return mcap::record(Op::Chunk, fields.bytes());
}

std::string index_of(std::uint16_t channel, int messages) {
  ByteWriter list;
  for (int i = 0; i < messages; ++i) list.u64(0).u64(0);
  return mcap::record(Op::MessageIndex, ByteWriter().u16(channel).text(list.bytes()).bytes());
}

std::vector<std::uint32_t> rest_of(RecordingStream& stream) {
  std::vector<std::uint32_t> seconds;
  for (auto message = stream.next(); message && *message; message = stream.next())
    seconds.push_back((*message)->sequence);
  return seconds;
}

TEST(RecordingStream, PutsChunksThatOverlapInOrder) {
  const std::string bytes = head_of_file() + chunk_of({{1, 5}, {1, 1}, {1, 8}}) +
                            chunk_of({{2, 4}, {2, 9}}) + chunk_of({{1, 2}, {1, 3}}) +
                            message_record({1, 6}) + message_record({1, 7}) + end_of_file();
  auto stream = RecordingStream::of_bytes(bytes);
  ASSERT_TRUE(stream);
  EXPECT_THAT(rest_of(*stream), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(stream->notes(), IsEmpty());
  EXPECT_FALSE(stream->truncated());
  stream->rewind();
  EXPECT_THAT(rest_of(*stream), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9)) << "again";
}

TEST(RecordingStream, HoldsFewChunksHoweverManyThereAre) {
  std::string bytes = head_of_file();
  constexpr int kChunks = 2000;
  for (int i = 0; i < kChunks; ++i) bytes += chunk_of({{1, 2 * i}, {1, 2 * i + 1}});
  bytes += end_of_file();
  const ReadLimits limits{.max_total_bytes = 2000};  // the file has 200 kB
  auto stream = RecordingStream::of_bytes(bytes, limits);
  ASSERT_TRUE(stream);
  EXPECT_EQ(rest_of(*stream).size(), 2u * kChunks);
  EXPECT_FALSE(read_recording_bytes(bytes, limits)) << "whole it is too large";
}

TEST(RecordingStream, RefusesChunksThatAreAllDueAtOnce) {
  std::string bytes = head_of_file();
  for (int i = 0; i < 2000; ++i) bytes += chunk_of({{1, 0}, {1, 5000 - i}});
  bytes += end_of_file();  // A stream reads from the caller's bytes.
  auto stream = RecordingStream::of_bytes(bytes, {.max_total_bytes = 20'000});
  ASSERT_TRUE(stream);
  auto message = stream->next();
  while (message && *message) message = stream->next();
  ASSERT_FALSE(message);
  EXPECT_EQ(message.error().code, ErrorCode::TooLarge);
}

TEST(RecordingStream, DoesNotUnpackWhatNobodyWants) {
  // The first chunk is broken; according to its index nothing in it is needed.
  const std::string bytes = head_of_file() + chunk_of({{1, 1}}, 7) + index_of(1, 1) +
                            chunk_of({{1, 2}, {2, 3}}) + index_of(1, 1) + index_of(2, 1) +
                            chunk_of({{1, 4}, {2, 5}}) + end_of_file();
  ReadLimits limits;
  limits.wanted = [](std::string_view topic) { return topic == "/b"; };
  auto stream = RecordingStream::of_bytes(bytes, limits);
  ASSERT_TRUE(stream);
  EXPECT_THAT(rest_of(*stream), ElementsAre(3, 5));
  EXPECT_THAT(stream->notes(), IsEmpty());
  EXPECT_FALSE(stream->count("/b")) << "the last chunk has no index";
}

TEST(RecordingStream, AnIndexThatIsCutOffIsNotBelieved) {
  const std::string bytes = head_of_file() + chunk_of({{1, 1}, {2, 2}}) + index_of(1, 1);
  ReadLimits limits;
  limits.wanted = [](std::string_view topic) { return topic == "/b"; };
  auto stream = RecordingStream::of_bytes(bytes, limits);
  ASSERT_TRUE(stream);
  EXPECT_THAT(rest_of(*stream), ElementsAre(2));
  EXPECT_TRUE(stream->truncated());
}

TEST(RecordingStream, KnowsTheLastMessageOfATopicAndHowManyThereAre) {
  const TemporaryFolder folder;
  {
    auto writer = RecordingWriter::create(folder / "a.mcap");
    const auto a = writer->add_channel({"/a", "", "", {}});
    const auto b = writer->add_channel({"/b", "", "", {}});
    for (int i = 0; i < 30; ++i) {
      const Timestamp t = from_unix_ns(static_cast<std::int64_t>(at(2 * i)));
      ASSERT_TRUE(writer->write(i < 3 ? *b : *a, {"", static_cast<std::uint32_t>(i), t, t, "{}"}));
    }
    ASSERT_TRUE(writer->close());
  }
  auto stream = RecordingStream::open(folder / "a.mcap");
  ASSERT_TRUE(stream);
  EXPECT_EQ(stream->count("/a"), 27u);
  EXPECT_EQ(stream->count("/b"), 3u);
  EXPECT_EQ(stream->count("/c"), 0u);
  EXPECT_EQ(stream->last_of("/a")->sequence, 29u);
  EXPECT_EQ(stream->last_of("/b")->sequence, 2u);
  EXPECT_FALSE(stream->last_of("/c"));
  EXPECT_EQ(rest_of(*stream).size(), 30u) << "looking ahead takes nothing away";
  stream->rewind(from_unix_ns(static_cast<std::int64_t>(at(54))));
  EXPECT_THAT(rest_of(*stream), ElementsAre(27, 28, 29));
}

TEST(RecordingStream, ChunksOfZerosCostNothing) {
  const std::string zeros(32u << 20, '\0');
  std::string packed(ZSTD_compressBound(zeros.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), zeros.data(), zeros.size(), 1));
  ByteWriter tight;
  tight.u64(0).u64(0).u64(zeros.size()).u32(0).text("zstd").u64(packed.size()).raw(packed);
  ByteWriter loose;
  loose.u64(0).u64(0).u64(9).u32(0).text("").u64(9).raw(std::string(9, '\0'));
  const std::string bytes = head_of_file() + mcap::record(Op::Chunk, tight.bytes()) +
                            mcap::record(Op::Chunk, loose.bytes()) + end_of_file();
  const auto read = read_recording_bytes(bytes);
  ASSERT_TRUE(read);
  EXPECT_THAT(read->notes, Contains(HasSubstr("chunk 1 left out: it claims more than 1000 times")));
  EXPECT_THAT(read->notes, Contains(HasSubstr("chunk 2 left out: it holds zeros")));
}

}  // namespace
}  // namespace chorus::record
