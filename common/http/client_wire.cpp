#include "common/http/client_wire.h"

#include <algorithm>

#include "common/http/text.h"

namespace chorus::http {
namespace {

bool is_one_line(std::string_view text) {
  return std::none_of(text.begin(), text.end(),
                      [](char c) { return c == '\r' || c == '\n' || c == '\0'; });
}

}  // namespace

std::string authority_of(const std::string& host, std::uint16_t port) {
  const bool v6 = host.find(':') != std::string::npos;
  return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

std::string request_text(const ClientRequest& request, const std::string& authority) {
  const std::string target = request.target.empty() ? "/" : request.target;
  std::string text = request.method + " " + target + " HTTP/1.1\r\nHost: " + authority;
  for (const auto& [name, value] : request.headers) text.append("\r\n" + name + ": " + value);
  if (!request.body.empty() || request.method == "POST" || request.method == "PUT")
    text.append("\r\nContent-Length: " + std::to_string(request.body.size()));
  return text.append("\r\n\r\n").append(request.body);
}

bool is_writable(const ClientRequest& request) {
  const bool lines = std::all_of(request.headers.begin(), request.headers.end(), [](const auto& h) {
    return is_one_line(h.first) && is_one_line(h.second);
  });
  const std::string line = request.method + request.target;
  return lines && is_one_line(line) && line.find(' ') == std::string::npos;
}

ClientResponse response_of(const boost::beast::http::response_header<>& head) {
  ClientResponse response;
  response.status = static_cast<int>(head.result_int());
  for (const auto& field : head) {
    const std::string name =
        to_lower(std::string_view(field.name_string().data(), field.name_string().size()));
    const std::string_view value(field.value().data(), field.value().size());
    auto [known, added] = response.headers.try_emplace(name, value);
    if (!added) known->second.append(", ").append(value);
  }
  return response;
}

}  // namespace chorus::http
