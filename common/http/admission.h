// For whom connections are counted.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/http/asio.h"
#include "common/http/request_head.h"

namespace chorus::http {

/// An IPv4 address as it is, also when it came mapped into IPv6; of an IPv6 address its first 64
/// bits, because a host takes as many of the others as it likes.
[[nodiscard]] std::string account_of(const net::ip::address& address);

/// The mapped IPv4 address as IPv4, any other as it is.
[[nodiscard]] net::ip::address unmapped(const net::ip::address& address);

/// Whom a proxy says it asks for: the last address of X-Forwarded-For, which the proxy itself has
/// written (those before it came from the client).
[[nodiscard]] std::optional<std::string> forwarded_account(const RequestHead& head);

}  // namespace chorus::http
