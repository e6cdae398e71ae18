// The addresses that a server accepts if its protocol has no passwords.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/net/asio.h"

namespace chorus::net {

/// A list of addresses and networks that are allowed; this host itself always is.
class AllowList {
 public:
  /// Parses "10.0.0.20", "10.0.0.0/24", "fd00::/8"; InvalidArgument names an entry of any other
  /// form.
  [[nodiscard]] static Result<AllowList> parse(const std::vector<std::string>& entries);

  [[nodiscard]] bool allows(const asio::ip::address& address) const;

  /// Why a client with this address is refused, and the key to change; empty when it is allowed.
  [[nodiscard]] std::string objection(const asio::ip::address& address, std::string_view key) const;

  bool operator==(const AllowList&) const = default;

 private:
  /// All addresses with the same first `bits` bits; IPv4 is mapped into IPv6.
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
