#include "common/service/http_config.h"

#include <string>

#include "common/http/client.h"
#include "common/net/address.h"

namespace chorus::service {
namespace {

void read_names(ConfigReader& config, http::ServerConfig& out) {
  config.read("hosts", out.hosts);
  for (const std::string& host : out.hosts) {
    if (host.empty() || host.find_first_of(":/ ") != std::string::npos)
      config.complain("hosts", "names only, without scheme and port, such as tracker.example");
  }
  config.read("trusted_proxies", out.trusted_proxies);
  for (std::string& proxy : out.trusted_proxies) {
    net::error_code failed;
    const auto address = asio::ip::make_address(proxy, failed);
    if (failed) {
      config.complain("trusted_proxies", "numeric addresses only, such as 127.0.0.1");
    } else {
      proxy = net::unmapped(address).to_string();
    }
  }
}

/// Complains about a token that somebody could guess.
void check_length(ConfigReader& config, std::string_view key, const std::string& token) {
  if (token.size() < kShortestToken)
    config.complain(key, "needs at least 12 characters, such as `openssl rand -hex 16` makes");
}

void read_tokens(ConfigReader& config, http::ServerConfig& http) {
  config.read("bearer_token", http.bearer_token);
  if (!http.bearer_token.empty()) check_length(config, "bearer_token", http.bearer_token);
  const auto names = {http::name_of(http::Role::Read), http::name_of(http::Role::Images),
                      http::name_of(http::Role::Control)};
  for (ConfigReader& reader : config.items("tokens")) {
    http::Token token{{}, http::Role::Read};
    std::size_t role = 0;
    reader.read("token", token.secret);
    reader.read_choice("role", role, names);
    token.role = static_cast<http::Role>(role);
    check_length(reader, "token", token.secret);
    http.tokens.push_back(std::move(token));
  }
}

void read_limits(ConfigReader& config, http::ServerLimits& out) {
  constexpr int kMax = 60'000;
  const auto read_count = [&](std::string_view key, std::size_t& count, int least) {
    int value = static_cast<int>(count);
    config.read(key, value, least, kMax);
    count = static_cast<std::size_t>(value);
  };
  read_count("max_connections", out.max_connections, 8);
  read_count("max_per_address", out.max_per_address, 1);
  read_count("max_long_polls", out.max_long_polls, 1);
  read_count("max_downloads", out.max_downloads, 1);
  constexpr double kMostRequests = 1e6;
  config.read("max_requests_per_s", out.max_requests_per_s, 0.0, kMostRequests);
}

}  // namespace

std::string root_of(const http::ServerConfig& http, bool secure, std::uint16_t port) {
  return http::url_text({http.address, port, {}, secure}, "/");
}

void read_identity(ConfigReader config, std::optional<tls::Identity>& out) {
  std::string certificate;
  std::string key;
  config.read("certificate", certificate);
  config.read("key", key);
  if (certificate.empty() && key.empty()) return;
  if (certificate.empty()) return config.complain("certificate", "is needed beside the key");
  if (key.empty()) return config.complain("key", "is needed beside the certificate");
  auto identity = tls::Identity::load(certificate, key);
  if (identity) {
    out = std::move(*identity);
  } else {
    const bool of_key = identity.error().context == key;
    config.complain(of_key ? "key" : "certificate", to_string(identity.error()));
  }
}

void read_http(ConfigReader config, http::ServerConfig& out) {
  config.read("address", out.address);
  int port = out.port;
  config.read("port", port, 0, 65535);
  out.port = static_cast<std::uint16_t>(port);
  read_tokens(config, out);
  read_identity(config.child("tls"), out.identity);
  config.read("allowed_origin", out.allowed_origin);
  read_names(config, out);
  read_limits(config, out.limits);
}

}  // namespace chorus::service
