#include "common/record/mcap_format.h"

#include <array>

namespace chorus::record::mcap {

namespace {

constexpr std::uint32_t kPolynomial = 0xEDB88320u;  // CRC-32, bits reversed

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? (c >> 1) ^ kPolynomial : c >> 1;
    table[i] = c;
  }
  return table;
}

constexpr auto kCrcTable = crc_table();

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far) {
  std::uint32_t c = ~so_far;
  for (const char byte : bytes) {
    c = kCrcTable[(c ^ static_cast<std::uint8_t>(byte)) & 0xFFu] ^ (c >> 8);
  }
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
