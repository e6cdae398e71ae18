#include "common/inertial/osc_message.h"

#include <bit>
#include <cstdint>
#include <string>

#include "common/inertial/stream_reader.h"

namespace chorus::inertial {
namespace {

constexpr std::size_t kMostMessages = 1000;
constexpr int kDeepest = 4;
constexpr std::string_view kBundleHead("#bundle\0", 8);

tl::unexpected<Error> cut_off() {
  return fail(ErrorCode::Malformed, "OSC packet", "ends too early");
}

class OscBytes {
 public:
  explicit OscBytes(std::string_view rest) : rest_(rest) {}

  [[nodiscard]] bool empty() const { return rest_.empty(); }
  [[nodiscard]] bool ok() const { return ok_; }
  std::string_view take(std::size_t size) {
    ok_ = ok_ && size <= rest_.size();
    const std::string_view part = rest_.substr(0, ok_ ? size : 0);
    rest_.remove_prefix(part.size());
    return part;
  }
  std::uint64_t bits(std::size_t bytes) {
    std::uint64_t value = 0;
    for (const char c : take(bytes)) value = value << 8 | static_cast<unsigned char>(c);
    return value;
  }
  /// Up to its NUL; the padding is taken, too.
  std::string_view text() {
    const std::size_t length = rest_.find('\0');
    if (length == std::string_view::npos) {
      ok_ = false;
      return {};
    }
    const std::string_view value = take(length);
    take(4 - length % 4);
    return value;
  }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

/// False for a type that is not known.
bool argument(char type, OscBytes& bytes, OscMessage& out) {
  const auto word = [&] { return static_cast<std::uint32_t>(bytes.bits(4)); };
  switch (type) {
    case 'i':
      out.numbers.push_back(static_cast<std::int32_t>(word()));
      return true;
    case 'f':
      out.numbers.push_back(static_cast<double>(std::bit_cast<float>(word())));
      return true;
    case 'h':
      out.numbers.push_back(static_cast<double>(static_cast<std::int64_t>(bytes.bits(8))));
      return true;
    case 'd':
      out.numbers.push_back(std::bit_cast<double>(bytes.bits(8)));
      return true;
    case 's':
      out.texts.push_back(bytes.text());
      return true;
    case 'b': {
      const std::size_t size = word();
      bytes.take(size);
      bytes.take((4 - size % 4) % 4);
      return true;
    }
    case 't':
      bytes.take(8);
      return true;
    default:  // Those without bytes.
      return type == 'T' || type == 'F' || type == 'N' || type == 'I';
  }
}

Result<void> read_packet(std::string_view packet, int depth, std::vector<OscMessage>& out);

Result<void> read_bundle(std::string_view packet, int depth, std::vector<OscMessage>& out) {
  if (depth >= kDeepest)
    return fail(ErrorCode::Malformed, "OSC packet", "holds bundles in bundles in bundles");
  OscBytes bytes(packet);
  bytes.take(kBundleHead.size() + 8);  // and the time tag
  if (!bytes.ok()) return cut_off();
  while (!bytes.empty()) {
    const std::string_view element = bytes.take(bytes.bits(4));
    if (!bytes.ok()) return cut_off();
    if (auto read = read_packet(element, depth + 1, out); !read) return read;
  }
  return {};
}

Result<void> read_packet(std::string_view packet, int depth, std::vector<OscMessage>& out) {
  if (packet.starts_with(kBundleHead)) return read_bundle(packet, depth, out);
  if (out.size() >= kMostMessages)
    return fail(ErrorCode::TooLarge, "OSC packet", "holds more than 1000 messages");
  OscBytes bytes(packet);
  OscMessage message;
  message.address = bytes.text();
  if (!bytes.ok() || !message.address.starts_with('/'))
    return fail(ErrorCode::Malformed, "OSC packet", "is no OSC: no address");
  const std::string_view types = bytes.empty() ? std::string_view(",") : bytes.text();
  if (!bytes.ok() || !types.starts_with(',')) return cut_off();
  for (const char type : types.substr(1))
    if (!argument(type, bytes, message))
      return fail(ErrorCode::Malformed, "OSC packet",
                  "has an argument of a type that is not known");
  if (!bytes.ok()) return cut_off();
  out.push_back(std::move(message));
  return {};
}

}  // namespace

Result<std::vector<OscMessage>> parse_osc(std::string_view packet) {
  if (packet.size() > kMaxStreamDatagram)
    return fail(ErrorCode::TooLarge, "OSC packet", "is longer than a datagram");
  std::vector<OscMessage> out;
  if (auto read = read_packet(packet, 0, out); !read) return pass(read);
  return out;
}

}  // namespace chorus::inertial
