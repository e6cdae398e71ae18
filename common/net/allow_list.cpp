#include "common/net/allow_list.h"

#include <algorithm>
#include <optional>

#include "common/base/parse.h"
#include "common/net/address.h"

namespace chorus::net {
namespace {

using Bytes = std::array<std::uint8_t, 16>;
constexpr unsigned kBitsBeforeV4 = 96;

Bytes bytes_of(const asio::ip::address& address) {
  const asio::ip::address plain = unmapped(address);
  if (plain.is_v6()) return plain.to_v6().to_bytes();
  return asio::ip::make_address_v6(asio::ip::v4_mapped, plain.to_v4()).to_bytes();
}

/// The length of the network prefix, counted in an IPv6 address (into which IPv4 is mapped): the
/// number after the slash or, if there is no slash, all bits.  None if the number is not valid.
std::optional<unsigned> bits_of(std::string_view length, bool is_v4) {
  const unsigned most = is_v4 ? 32 : 128;
  const auto bits = length.empty() ? most : parse_number<unsigned>(length.substr(1));
  if (!bits || *bits > most) return std::nullopt;
  return is_v4 ? *bits + kBitsBeforeV4 : *bits;
}

}  // namespace

Result<AllowList> AllowList::parse(const std::vector<std::string>& entries) {
  AllowList list;
  for (const std::string& entry : entries) {
    const std::size_t slash = std::min(entry.find('/'), entry.size());
    error_code failed;
    const auto address = asio::ip::make_address(entry.substr(0, slash), failed);
    const auto bits =
        failed ? std::nullopt
               : bits_of(std::string_view(entry).substr(slash), unmapped(address).is_v4());
    if (!bits) {
      return fail(ErrorCode::InvalidArgument, entry,
                  "is neither a numeric address nor a network, such as 10.0.0.20 or 10.0.0.0/24");
    }
    list.networks_.push_back({bytes_of(address), *bits});
  }
  return list;
}

bool AllowList::contains(const Network& network, const Bytes& bytes) {
  for (unsigned bit = 0; bit < network.bits; bit += 8) {
    const unsigned left = network.bits - bit;
    const auto mask = static_cast<std::uint8_t>(left >= 8 ? 0xFF : 0xFF << (8 - left));
    if (((bytes[bit / 8] ^ network.bytes[bit / 8]) & mask) != 0) return false;
  }
  return true;
}

bool AllowList::allows(const asio::ip::address& address) const {
  if (unmapped(address).is_loopback()) return true;
  const Bytes bytes = bytes_of(address);
  return std::any_of(networks_.begin(), networks_.end(),
                     [&](const Network& network) { return contains(network, bytes); });
}

std::string AllowList::objection(const asio::ip::address& address, std::string_view key) const {
  if (allows(address)) return {};
  return unmapped(address).to_string() + " is not listed; add it to " + std::string(key);
}

}  // namespace chorus::net
