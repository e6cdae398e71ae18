// The section "http" of a configuration, the same for every service.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/base/config_reader.h"
#include "common/http/server.h"
#include "common/tls/credentials.h"

namespace chorus::service {

/// An absent key keeps the value in `out`, because each service has its own default port.
void read_http(ConfigReader config, http::ServerConfig& out);

/// "https://0.0.0.0:8081/": the address of a service.
[[nodiscard]] std::string root_of(const http::ServerConfig& http, bool secure, std::uint16_t port);

/// The certificate and key named by the child "tls"; none when it names none.
void read_identity(ConfigReader config, std::optional<tls::Identity>& out);

}  // namespace chorus::service
