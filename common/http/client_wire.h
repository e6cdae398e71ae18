// What both clients share: the bytes of a request, the fields of an answer.
#pragma once

#include <string>
#include <string_view>

#include "common/http/beast.h"
#include "common/http/client.h"

namespace chorus::http {

/// Limit for the status line and the fields of an answer; a longer head ends the connection.
inline constexpr std::uint32_t kMaxAnswerHeadBytes = 16384;

/// "127.0.0.1:8080", "[::1]:8080".
[[nodiscard]] std::string authority_of(const std::string& host, std::uint16_t port);

/// False when a value contains characters that would begin another header field or request.
[[nodiscard]] bool is_writable(const ClientRequest& request);

[[nodiscard]] std::string request_text(const ClientRequest& request, const std::string& authority);

/// The status and the fields of an answer, with an empty body.
[[nodiscard]] ClientResponse response_of(const boost::beast::http::response_header<>& head);

}  // namespace chorus::http
