#include "common/record/mcap_format.h"

#include <gtest/gtest.h>

namespace chorus::record::mcap {
namespace {

TEST(Crc32, MatchesThePublishedCheckValue) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926u);  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(crc32(""), 0u);
}

TEST(Crc32, IsTheSameInStepsOfOneByteAsInOneStep) {
  std::string bytes;
  std::uint32_t one_by_one = 0;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(crc32(bytes), one_by_one) << bytes.size() << " bytes";
    const auto next = static_cast<char>(i * 37 + i * i);
    one_by_one = crc32(std::string_view(&next, 1), one_by_one);
    bytes += next;
  }
}

TEST(Crc32, ContinuesAnEarlierOne) { EXPECT_EQ(crc32("456789", crc32("123")), crc32("123456789")); }

TEST(ByteWriter, WritesLittleEndian) {
  const std::string bytes = ByteWriter().u8(1).u16(0x0302).u32(0x07060504).u64(8).bytes();
  EXPECT_EQ(bytes, std::string("\1\2\3\4\5\6\7\10\0\0\0\0\0\0\0", 15));
}

TEST(ByteReader, ReadsBackWhatWasWritten) {
  const std::map<std::string, std::string> map{{"a", "1"}, {"b", ""}};
  const std::string bytes = ByteWriter().u16(65535).u64(~0ull).text("topic").strings(map).bytes();
  ByteReader reader(bytes);
  EXPECT_EQ(reader.u16(), 65535);
  EXPECT_EQ(reader.u64(), ~0ull);
  EXPECT_EQ(reader.text(), "topic");
  EXPECT_EQ(reader.strings(), map);
  EXPECT_TRUE(reader.ok());
  EXPECT_TRUE(reader.rest().empty());
}

TEST(ByteReader, RunningOverTheEndIsNotedAndYieldsNothing) {
  ByteReader reader(
      "\xff\xff\xff\xff"
      "abc");
  EXPECT_EQ(reader.text(), "");
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.u32(), 0u) << "after a failure nothing is read any more";
}

TEST(ByteReader, AMapCutInsideAnEntryIsRefused) {
  const std::string inner = ByteWriter().text("key").u32(99).bytes();
  const std::string bytes = ByteWriter().text(inner).bytes();
  ByteReader reader(bytes);
  EXPECT_TRUE(reader.strings().empty());
  EXPECT_FALSE(reader.ok());
}

}  // namespace
}  // namespace chorus::record::mcap
