// The byte format of MCAP version 0 (https://mcap.dev/spec): opcodes, little-endian fields, CRC.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace chorus::record::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t kRecordHead = 1 + 8;  ///< Opcode and 64-bit content length.

enum class Op : std::uint8_t {
  Header = 0x01,
  Footer = 0x02,
  Schema = 0x03,
  Channel = 0x04,
  Message = 0x05,
  Chunk = 0x06,
  MessageIndex = 0x07,
  ChunkIndex = 0x08,
  Statistics = 0x0B,
  Metadata = 0x0C,
  MetadataIndex = 0x0D,
  SummaryOffset = 0x0E,
  DataEnd = 0x0F,
};

/// CRC-32 (ISO 3309, as in zip); to continue, pass the CRC of the preceding bytes as `so_far`.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far = 0);

/// Appends the fields of a record one after the other.
class ByteWriter {
 public:
  ByteWriter& u8(std::uint8_t v) { return fixed(v, 1); }
  ByteWriter& u16(std::uint16_t v) { return fixed(v, 2); }
  ByteWriter& u32(std::uint32_t v) { return fixed(v, 4); }
  ByteWriter& u64(std::uint64_t v) { return fixed(v, 8); }
  ByteWriter& raw(std::string_view bytes);
  ByteWriter& text(std::string_view bytes);  ///< 32-bit length, then the bytes.
  ByteWriter& strings(const std::map<std::string, std::string>& map);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  ByteWriter& fixed(std::uint64_t v, int width);
  std::string bytes_;
};

/// One record: opcode, length, content.
[[nodiscard]] std::string record(Op op, std::string_view content);

/// Takes fields off a byte range.  Beyond the end it returns zeros and empty strings, and ok()
/// becomes false; so the caller can read a whole record first and check once.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(fixed(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(fixed(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(fixed(4)); }
  std::uint64_t u64() { return fixed(8); }
  std::string_view raw(std::uint64_t count);
  std::string_view text() { return raw(u32()); }
  std::map<std::string, std::string> strings();

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::uint64_t fixed(std::size_t width);
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace chorus::record::mcap
