// HTTP clients: a blocking one for tools and tests, an asynchronous one for polling.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/http/document.h"
#include "common/tls/credentials.h"

namespace boost::asio {
class io_context;
}

namespace chorus::http {

struct Url {
  std::string host;
  std::uint16_t port = 80;
  std::string target = "/";
  bool secure = false;  ///< https
};

/// Parses http://host[:port][/path][?query], or https:// with 443 as the default port.  A fragment
/// ("#...") is dropped; anything else is InvalidArgument.
[[nodiscard]] Result<Url> parse_url(std::string_view text);

/// "https://host:port/path", with `target` as the path.
[[nodiscard]] std::string url_text(const Url& url, std::string_view target);

struct ClientRequest {
  std::string method = "GET";
  std::string target = {};  ///< Empty: the target of the Url in fetch(), otherwise "/".
  std::vector<Header> headers = {};
  std::string body = {};
};

struct ClientResponse {
  int status = 0;
  std::map<std::string, std::string, std::less<>> headers;  ///< The names are in lower case.
  std::string body;
  std::int64_t sent_ns = 0;      ///< UTC by our clock when the request left: t0.
  std::int64_t received_ns = 0;  ///< UTC by our clock when the answer was complete: t3.
};

struct ClientLimits {
  std::size_t max_body_bytes = 16u << 20;
  std::chrono::milliseconds connect_timeout{2000};
  std::chrono::milliseconds answer_timeout{10000};
};

/// Sends one request on its own connection and blocks until the answer is complete.
/// `trust`: the authorities accepted for an https:// server.
[[nodiscard]] Result<ClientResponse> fetch(const Url& url, const ClientRequest& request,
                                           const ClientLimits& limits = {},
                                           const tls::Trust& trust = {});

/// One kept-alive connection on the caller's io_context: one request at a time, callbacks on the
/// io_context's thread.  Reconnects on demand; if the server has closed the connection meanwhile, a
/// GET or HEAD is repeated on a new one.  The destructor and close() cancel the request: its
/// callback is then never called.  Call all functions and the destructor on the io_context's
/// thread, or while the io_context does not run.
class AsyncClient {
 public:
  using Callback = std::function<void(Result<ClientResponse>)>;

  AsyncClient(boost::asio::io_context& io, std::string host, std::uint16_t port,
              ClientLimits limits = {});
  /// Uses the URL's host, port and scheme, but not its target.
  AsyncClient(boost::asio::io_context& io, const Url& url, ClientLimits limits = {},
              const tls::Trust& trust = {});
  ~AsyncClient();
  void send(ClientRequest request, std::chrono::milliseconds answer_timeout, Callback callback);
  void close();

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace chorus::http
