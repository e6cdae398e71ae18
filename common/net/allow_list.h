// The addresses that a server of a protocol without passwords answers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/net/asio.h"

namespace chorus::net {

/// This host itself, and the listed addresses and networks.
class AllowList {
 public:
  /// Reads "10.0.0.20", "10.0.0.0/24", "fd00::/8"; InvalidArgument names any other entry.
  [[nodiscard]] static Result<AllowList> parse(const std::vector<std::string>& entries);

  [[nodiscard]] bool allows(const asio::ip::address& address) const;

  /// Why a client with this address is refused, and the key to change; empty when it is allowed.
  [[nodiscard]] std::string objection(const asio::ip::address& address, std::string_view key) const;

  bool operator==(const AllowList&) const = default;

 private:
  /// All addresses with the same first bits; IPv4 is mapped into IPv6.
  struct Network {
    std::array<std::uint8_t, 16> bytes{};
    unsigned bits = 0;

    bool operator==(const Network&) const = default;
  };
  [[nodiscard]] static bool contains(const Network& network,
                                     const std::array<std::uint8_t, 16>& bytes);

  std::vector<Network> networks_;
};

}  // namespace chorus::net
