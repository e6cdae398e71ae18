#include "common/record/mcap_format.h"

#include <array>
#include <bit>
#include <cstring>

namespace chorus::record::mcap {

namespace {

constexpr std::uint32_t kPolynomial = 0xEDB88320u;  // CRC-32, bits reversed

constexpr std::size_t kSlices = 8;  // Bytes per step; this is four times faster than single bytes.
using CrcTable = std::array<std::uint32_t, 256>;

/// Table n is the effect of a byte on the CRC when n more bytes follow it.
constexpr std::array<CrcTable, kSlices> crc_tables() {
  std::array<CrcTable, kSlices> tables{};
  for (std::uint32_t i = 0; i < tables[0].size(); ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? (c >> 1) ^ kPolynomial : c >> 1;
    tables[0][i] = c;
  }
  for (std::size_t row = 1; row < kSlices; ++row) {
    for (std::size_t i = 0; i < tables[0].size(); ++i) {
      const std::uint32_t before = tables[row - 1][i];
      tables[row][i] = (before >> 8) ^ tables[0][before & 0xFFu];
    }
  }
  return tables;
}

constexpr auto kCrcTables = crc_tables();

std::uint32_t byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<std::uint8_t>(bytes[i]);
}

/// Reads a little-endian word.
std::uint32_t word_at(std::string_view bytes, std::size_t i) {
  static_assert(std::endian::native == std::endian::little);
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + i, sizeof word);
  return word;
}

std::uint32_t sliced(std::uint32_t low, std::uint32_t high) {
  const auto& t = kCrcTables;
  return t[7][low & 0xFFu] ^ t[6][low >> 8 & 0xFFu] ^ t[5][low >> 16 & 0xFFu] ^ t[4][low >> 24] ^
         t[3][high & 0xFFu] ^ t[2][high >> 8 & 0xFFu] ^ t[1][high >> 16 & 0xFFu] ^ t[0][high >> 24];
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far) {
  std::uint32_t c = ~so_far;
  std::size_t i = 0;
  for (; i + kSlices <= bytes.size(); i += kSlices)
    c = sliced(c ^ word_at(bytes, i), word_at(bytes, i + 4));
  for (; i < bytes.size(); ++i) c = kCrcTables[0][(c ^ byte_at(bytes, i)) & 0xFFu] ^ (c >> 8);
  return ~c;
}

ByteWriter& ByteWriter::fixed(std::uint64_t v, int width) {
  for (int i = 0; i < width; ++i) bytes_.push_back(static_cast<char>((v >> (8 * i)) & 0xFFu));
  return *this;
}

ByteWriter& ByteWriter::raw(std::string_view bytes) {
  bytes_.append(bytes);
  return *this;
}

ByteWriter& ByteWriter::text(std::string_view bytes) {
  return u32(static_cast<std::uint32_t>(bytes.size())).raw(bytes);
}

ByteWriter& ByteWriter::strings(const std::map<std::string, std::string>& map) {
  ByteWriter entries;
  for (const auto& [key, value] : map) entries.text(key).text(value);
  return text(entries.bytes());
}

std::string record(Op op, std::string_view content) {
  ByteWriter out;
  out.u8(static_cast<std::uint8_t>(op)).u64(content.size()).raw(content);
  return out.bytes();
}

std::uint64_t ByteReader::fixed(std::size_t width) {
  const std::string_view bytes = raw(width);
  std::uint64_t v = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    v |= std::uint64_t{static_cast<std::uint8_t>(bytes[i])} << (8 * i);
  }
  return v;
}

std::string_view ByteReader::raw(std::uint64_t count) {
  if (!ok_ || count > rest_.size()) {
    ok_ = false;
    return {};
  }
  const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
  rest_.remove_prefix(taken.size());
  return taken;
}

std::map<std::string, std::string> ByteReader::strings() {
  std::map<std::string, std::string> map;
  ByteReader entries(text());
  while (entries.ok() && !entries.rest().empty()) {
    const std::string_view key = entries.text();
    const std::string_view value = entries.text();
    if (entries.ok()) map[std::string(key)] = std::string(value);
  }
  ok_ = ok_ && entries.ok();
  return map;
}

}  // namespace chorus::record::mcap
