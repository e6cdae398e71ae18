// Addresses in the form that limits and logs use.
#pragma once

#include <string>

#include "common/net/asio.h"

namespace chorus::net {

/// Turns an IPv4 address that is mapped into IPv6 into plain IPv4; other addresses stay unchanged.
[[nodiscard]] asio::ip::address unmapped(const asio::ip::address& address);

/// The account that a connection is counted for: an IPv4 address, or the first 64 bits of an IPv6
/// address, because one host may use any of the remaining bits.  Of the loopback address ::1 all
/// bits count.
[[nodiscard]] std::string account_of(const asio::ip::address& address);

}  // namespace chorus::net
