#include "common/net/address.h"

#include <algorithm>
#include <cstdint>

namespace chorus::net {

asio::ip::address unmapped(const asio::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

std::string account_of(const asio::ip::address& address) {
  const asio::ip::address plain = unmapped(address);
  if (plain.is_v4() || plain.is_loopback()) return plain.to_string();
  constexpr std::size_t kNetBytes = 8;
  auto bytes = plain.to_v6().to_bytes();
  std::fill(bytes.begin() + kNetBytes, bytes.end(), std::uint8_t{0});
  return asio::ip::make_address_v6(bytes).to_string() + "/64";
}

}  // namespace chorus::net
