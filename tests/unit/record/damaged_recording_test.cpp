// Files as a crash, a bad disk or an attacker leaves them: refused or read in part, always with a
// reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include "common/record/mcap_format.h"
#include "common/record/recording.h"
#include "tests/support/temporary_folder.h"

namespace chorus::record {
namespace {

using chorus::testing::bytes_of;
using chorus::testing::TemporaryFolder;
using mcap::ByteWriter;
using mcap::Op;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A file of three chunks of ten messages each.
std::string sound_file() {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "a.mcap");
  const auto channel = writer->add_channel({"/frame", "chorus.Frame", "{}", {}});
  for (int i = 0; i < 30; ++i) {
    const Timestamp t = from_unix_ns(0) + std::chrono::seconds(2) * (i / 10);
    (void)writer->write(*channel, {"", static_cast<std::uint32_t>(i), t, t, "{\"frame\":1}"});
  }
  (void)writer->close();
  return bytes_of(folder / "a.mcap");
}

std::string start_of_file() {
  std::string bytes(mcap::kMagic);
  bytes += mcap::record(Op::Header, ByteWriter().text("").text("test").bytes());
  bytes += mcap::record(Op::Channel,
                        ByteWriter().u16(1).u16(0).text("/frame").text("json").text("").bytes());
  return bytes;
}

std::string message_record(std::uint16_t channel) {
  return mcap::record(Op::Message,
                      ByteWriter().u16(channel).u32(0).u64(5).u64(5).raw("{}").bytes());
}

std::string chunk_record(std::uint64_t claimed, std::uint32_t crc, std::string_view compression,
                         std::string_view packed) {
  ByteWriter fields;
  fields.u64(0).u64(0).u64(claimed).u32(crc).text(compression).u64(packed.size()).raw(packed);
  return mcap::record(Op::Chunk, fields.bytes());
}

std::string damaged_end() {
  std::string bytes = mcap::record(Op::DataEnd, ByteWriter().u32(0).bytes());
  bytes += mcap::record(Op::Footer, ByteWriter().u64(0).u64(0).u32(0).bytes());
  return bytes + std::string(mcap::kMagic);
}

TEST(DamagedRecording, IsReadUpToTheLastCompleteChunkWhereverItIsCut) {
  const std::string whole = sound_file();
  std::size_t last = 0;
  for (std::size_t size = mcap::kMagic.size(); size < whole.size(); ++size) {
    const auto read = read_recording_bytes(whole.substr(0, size));
    ASSERT_TRUE(read) << "cut at " << size;
    EXPECT_TRUE(read->truncated) << "cut at " << size;
    EXPECT_EQ(read->messages.size() % 10, 0u) << "cut at " << size;
    EXPECT_GE(read->messages.size(), last) << "cut at " << size;
    last = read->messages.size();
  }
  EXPECT_EQ(last, 30u);
  EXPECT_FALSE(read_recording_bytes(whole)->truncated);
}

TEST(DamagedRecording, AFlippedByteCostsAtMostItsChunkAndIsNamed) {
  const std::string whole = sound_file();
  std::size_t refused_chunks = 0;
  for (std::size_t at = mcap::kMagic.size(); at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    const auto read = read_recording_bytes(bytes);
    if (!read) continue;
    for (const Message& m : read->messages) {
      if (m.data != "{\"frame\":1}") ADD_FAILURE() << "a damaged message came through, byte " << at;
    }
    const bool named = !read->notes.empty() && read->notes[0].starts_with("chunk");
    if (named && read->messages.size() == 20) ++refused_chunks;
  }
  EXPECT_GT(refused_chunks, 100u);
}

TEST(DamagedRecording, AWrongChecksumIsNamed) {
  const std::string records = message_record(1);
  const auto read = read_recording_bytes(
      start_of_file() + chunk_record(records.size(), mcap::crc32(records) ^ 1u, "", records) +
      chunk_record(records.size(), mcap::crc32(records), "", records) + damaged_end());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->messages.size(), 1u);
  EXPECT_THAT(read->notes, Contains(HasSubstr("chunk 1 left out: its checksum is wrong")));
}

TEST(DamagedRecording, AZipBombIsRefusedBeforeItUnpacks) {
  const std::string zeros(100u << 20, '\0');
  std::string packed(ZSTD_compressBound(zeros.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), zeros.data(), zeros.size(), 1));
  const auto honest =
      read_recording_bytes(start_of_file() + chunk_record(zeros.size(), 0, "zstd", packed));
  EXPECT_THAT(honest->notes, Contains(HasSubstr("the limit is")));
  const auto lying = read_recording_bytes(start_of_file() + chunk_record(10, 0, "zstd", packed));
  EXPECT_THAT(lying->notes, Contains(HasSubstr("disagree")));
}

TEST(DamagedRecording, ManyChunksTogetherStayBelowTheTotalLimit) {
  std::string records;
  for (int i = 0; i < 100; ++i) records += message_record(1);
  const std::string chunk = chunk_record(records.size(), 0, "", records);
  std::string bytes = start_of_file();
  for (int i = 0; i < 100; ++i) bytes += chunk;
  const ReadLimits limits{.max_total_bytes = 100'000};
  const auto read = read_recording_bytes(bytes + damaged_end(), limits);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::TooLarge);
}

TEST(DamagedRecording, ChannelsAndSchemasCountTowardsTheTotalLimit) {
  std::string schema = start_of_file();
  schema += mcap::record(
      Op::Schema,
      ByteWriter().u16(1).text("s").text("jsonschema").text(std::string(10'000, 'x')).bytes());
  const auto channel = [](std::uint16_t id) {
    return mcap::record(Op::Channel,
                        ByteWriter().u16(id).u16(1).text("/t").text("json").text("").bytes());
  };
  std::string many = schema;
  for (std::uint16_t id = 2; id < 1000; ++id) many += channel(id);
  std::string repeated = schema;
  for (int i = 0; i < 1000; ++i) repeated += channel(2);
  const ReadLimits limits{.max_total_bytes = 100'000};
  const auto refused = read_recording_bytes(many + damaged_end(), limits);
  ASSERT_FALSE(refused) << "45 kB that would take 10 MB";
  EXPECT_EQ(refused.error().code, ErrorCode::TooLarge);
  EXPECT_TRUE(read_recording_bytes(repeated + damaged_end(), limits)) << "as writers do";
}

TEST(DamagedRecording, UnknownRecordsAreSkippedSilently) {
  const std::string records = mcap::record(static_cast<Op>(0x80), "private") + message_record(1);
  const auto read =
      read_recording_bytes(start_of_file() + mcap::record(static_cast<Op>(0x7F), "future") +
                           mcap::record(Op::MessageIndex, "") +
                           chunk_record(records.size(), 0, "", records) + damaged_end());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->messages.size(), 1u);
  EXPECT_THAT(read->notes, IsEmpty());
  EXPECT_FALSE(read->truncated);
}

TEST(DamagedRecording, UnknownCompressionAndUnknownChannelsAreNamed) {
  const std::string records = message_record(7);
  const auto read =
      read_recording_bytes(start_of_file() + chunk_record(4, 0, "lz4", "abcd") +
                           chunk_record(records.size(), 0, "", records) + damaged_end());
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->messages.empty());
  EXPECT_THAT(read->notes, Contains(HasSubstr("neither zstd nor none")));
  EXPECT_THAT(read->notes, Contains(HasSubstr("channel 7")));
}

TEST(DamagedRecording, MessagesOutsideChunksAreRead) {
  const auto read = read_recording_bytes(start_of_file() + message_record(1) + damaged_end());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->messages.size(), 1u);
}

TEST(DamagedRecording, LengthsThatLieAreHarmless) {
  const auto huge = ByteWriter().u8(static_cast<std::uint8_t>(Op::Chunk)).u64(~0ull).bytes();
  const auto read = read_recording_bytes(start_of_file() + huge + "short");
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->truncated);
  std::string broken = message_record(1);
  broken[1] = 9;  // the record claims to end inside its own fields
  broken = broken.substr(0, mcap::kRecordHead + 9);
  const auto cut =
      read_recording_bytes(start_of_file() + chunk_record(broken.size(), 0, "", broken));
  EXPECT_THAT(cut->notes, Contains(HasSubstr("a message record is cut short")));
}

TEST(DamagedRecording, NotesAreBounded) {
  std::string bytes = start_of_file();
  for (int i = 0; i < 1000; ++i) bytes += chunk_record(4, 0, "lz4", "abcd");
  EXPECT_EQ(read_recording_bytes(bytes)->notes.size(), kMaxNotes);
}

TEST(DamagedRecording, OtherFilesAreRefused) {
  EXPECT_EQ(read_recording_bytes("").error().code, ErrorCode::Malformed);
  EXPECT_EQ(read_recording_bytes("#!/bin/sh\n").error().code, ErrorCode::Malformed);
  EXPECT_EQ(read_recording("/nowhere/at/all.mcap").error().code, ErrorCode::NotFound);
  EXPECT_EQ(read_recording_bytes(sound_file(), {.max_file_bytes = 10}).error().code,
            ErrorCode::TooLarge);
}

}  // namespace
}  // namespace chorus::record
