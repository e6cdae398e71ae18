// The section "http" of a configuration, the same for every service.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "common/base/config_reader.h"
#include "common/http/server.h"
#include "common/tls/credentials.h"

namespace chorus::service {

/// Shorter tokens are refused: somebody could guess them.
inline constexpr std::size_t kShortestToken = 12;

/// Reads the section; an absent key keeps the value in `out`, because each service has its own
/// default port.
void read_http(ConfigReader config, http::ServerConfig& out);

/// The address of a service: "https://0.0.0.0:8081/".
[[nodiscard]] std::string root_of(const http::ServerConfig& http, bool secure, std::uint16_t port);

/// Reads the certificate and key that the child "tls" names; leaves `out` as it is when it names
/// none.
void read_identity(ConfigReader config, std::optional<tls::Identity>& out);

}  // namespace chorus::service
