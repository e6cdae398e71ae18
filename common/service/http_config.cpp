#include "common/service/http_config.h"

namespace chorus::service {

void read_http(ConfigReader config, http::ServerConfig& out) {
  config.read("address", out.address);
  int port = out.port;
  config.read("port", port, 0, 65535);
  out.port = static_cast<std::uint16_t>(port);
  config.read("bearer_token", out.bearer_token);
  config.read("allowed_origin", out.allowed_origin);
}

bool differ_in_token_at_most(const http::ServerConfig& a, const http::ServerConfig& b) {
  http::ServerConfig same_token = b;
  same_token.bearer_token = a.bearer_token;
  return a == same_token;
}

}  // namespace chorus::service
