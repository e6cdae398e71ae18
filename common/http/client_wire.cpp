#include "common/http/client_wire.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "common/http/text.h"

namespace chorus::http {
namespace {

bool is_one_line(std::string_view text) {
  return std::none_of(text.begin(), text.end(),
                      [](char c) { return c == '\r' || c == '\n' || c == '\0'; });
}

/// The addresses of a host, tried one after the other.
struct Attempt : std::enable_shared_from_this<Attempt> {
  Attempt(Connecting whereto, Socket& on, Connected then)
      : to(std::move(whereto)), socket(on), done(std::move(then)) {}

  void next() {
    const tcp::endpoint endpoint = endpoints.front();
    endpoints.erase(endpoints.begin());
    error_code ignored;
    socket.close(ignored);
    socket.async_connect(endpoint, [self = shared_from_this()](error_code failed) {
      if (!self->to.wanted()) return;
      if (failed && !self->endpoints.empty()) return self->next();
      error_code unimportant;
      if (!failed) self->socket.set_option(tcp::no_delay(true), unimportant);
      self->done(failed, "connect");
    });
  }

  Connecting to;
  Socket& socket;
  Connected done;
  std::vector<tcp::endpoint> endpoints;
};

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

void connect_to(Connecting to, Resolver& resolver, Socket& socket, Connected done) {
  const std::string host = to.host;
  const std::uint16_t port = to.port;
  auto attempt = std::make_shared<Attempt>(std::move(to), socket, std::move(done));
  error_code no_literal;
  const auto address = net::ip::make_address(host, no_literal);
  if (!no_literal) {
    attempt->endpoints.emplace_back(address, port);
    return attempt->next();
  }
  resolver.async_resolve(host, std::to_string(port),
                         [attempt](error_code failed, const auto& results) {
                           if (!attempt->to.wanted()) return;
                           for (const auto& entry : results)
                             attempt->endpoints.push_back(entry.endpoint());
                           if (!failed && attempt->endpoints.empty())
                             failed = net::error::host_not_found;
                           failed ? attempt->done(failed, "find the host") : attempt->next();
                         });
}

}  // namespace chorus::http
