#include "common/suit/mxtp_datagram.h"

#include <algorithm>
#include <cctype>

#include "common/suit/big_endian_reader.h"

namespace chorus::suit {
namespace {

constexpr std::size_t kPayloadAt = 22;  // Where a header states the size of its payload.

/// Bytes of one item; 0 where items have no fixed size.
std::size_t item_bytes(int type) {
  if (type == static_cast<int>(MxtpType::Euler)) return 28;
  if (type == static_cast<int>(MxtpType::Quaternion)) return 32;
  return 0;
}

Result<int> type_in(std::string_view magic) {
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  if (!magic.starts_with("MXTP") || !digit(magic[4]) || !digit(magic[5]))
    return fail(ErrorCode::Malformed, "MXTP", "the datagram does not begin with MXTP and a type");
  return 10 * (magic[4] - '0') + (magic[5] - '0');
}

struct Header {
  MxtpDatagram datagram;
  std::size_t payload = 0;  ///< [bytes]; programs before 2019 leave it 0.
};

/// `bytes` has at least kMxtpHeaderBytes.
Result<Header> header_in(std::span<const char> bytes) {
  BigEndianReader reader(bytes);
  const auto type = type_in(reader.text(6));
  if (!type) return pass(type);
  Header out;
  out.datagram.type = *type;
  out.datagram.sample = reader.number(4);
  const std::uint32_t counter = reader.number(1);
  out.datagram.part = static_cast<int>(counter & 0x7FU);
  out.datagram.last = (counter & 0x80U) != 0;
  out.datagram.items = static_cast<int>(reader.number(1));
  out.datagram.time_ms = reader.number(4);
  out.datagram.character = static_cast<int>(reader.number(1));
  reader.text(kPayloadAt - 17);
  out.payload = reader.number(2);
  if (out.payload == 0)
    out.payload = static_cast<std::size_t>(out.datagram.items) * item_bytes(*type);
  return out;
}

}  // namespace

Result<MxtpDatagram> read_mxtp(std::span<const char> bytes) {
  if (bytes.size() < kMxtpHeaderBytes)
    return fail(ErrorCode::Malformed, "MXTP", "a datagram has at least 24 bytes");
  if (bytes.size() > kMaxMxtpBytes)
    return fail(ErrorCode::TooLarge, "MXTP", "a datagram has at most 65507 bytes");
  auto header = header_in(bytes);
  if (!header) return pass(header);
  MxtpDatagram& out = header->datagram;
  // Datagrams whose size is not stated and cannot be computed are as long as what has come.
  const std::size_t came = bytes.size() - kMxtpHeaderBytes;
  const std::size_t size = header->payload == 0 ? came : header->payload;
  if (size > came || static_cast<std::size_t>(out.items) * item_bytes(out.type) > size)
    return fail(ErrorCode::Malformed, "MXTP", "the datagram is shorter than its items");
  out.payload = bytes.subspan(kMxtpHeaderBytes, size);
  return out;
}

Result<void> MxtpStream::add(std::span<const char> bytes) {
  if (waiting_.size() + bytes.size() > 4 * kMaxMxtpBytes)
    return fail(ErrorCode::TooLarge, "MXTP", "more bytes than a datagram can have wait");
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  return {};
}

Result<std::optional<std::vector<char>>> MxtpStream::next() {
  if (waiting_.size() < kMxtpHeaderBytes) return std::nullopt;
  const auto header = header_in(waiting_);
  if (!header) return pass(header);
  if (header->payload == 0 && header->datagram.items > 0)
    return fail(ErrorCode::Unsupported, "MXTP",
                "a stream of datagrams that do not state their size; let MVN send over UDP");
  const std::size_t size = kMxtpHeaderBytes + header->payload;
  if (waiting_.size() < size) return std::nullopt;
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(size);
  std::vector<char> datagram(waiting_.begin(), end);
  waiting_.erase(waiting_.begin(), end);
  return datagram;
}

}  // namespace chorus::suit
