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

namespace boost::asio {
class io_context;
}

namespace chorus::http {

struct Url {
  std::string host;
  std::uint16_t port = 80;
  std::string target = "/";
};

/// Reads http://host[:port][/path][?query]; anything else is InvalidArgument.
[[nodiscard]] Result<Url> parse_url(std::string_view text);

struct ClientRequest {
  std::string method = "GET";
  std::string target = {};  ///< Empty: that of the Url in fetch(), else "/".
  std::vector<Header> headers = {};
  std::string body = {};
};

struct ClientResponse {
  int status = 0;
  std::map<std::string, std::string, std::less<>> headers;  ///< Lower-case names.
  std::string body;
  std::int64_t sent_ns = 0;      ///< Our UTC when the request left and the answer was complete:
  std::int64_t received_ns = 0;  ///< t0 and t3 of the clock model.
};

struct ClientLimits {
  std::size_t max_body_bytes = 16u << 20;
  std::chrono::milliseconds connect_timeout{2000};
  std::chrono::milliseconds answer_timeout{10000};
};

/// One request on a connection of its own; blocks.
[[nodiscard]] Result<ClientResponse> fetch(const Url& url, const ClientRequest& request,
                                           const ClientLimits& limits = {});

/// One kept-alive connection on somebody else's io_context: one request at a time, callbacks on its
/// thread.  Reconnects on demand; a GET on a connection that was closed meanwhile is sent again on
/// a new one.  Destroying it, or close(), cancels: the callback is then never called.  All calls,
/// and the destructor, belong on the io_context's thread (or before it runs, or after).
class AsyncClient {
 public:
  using Callback = std::function<void(Result<ClientResponse>)>;

  AsyncClient(boost::asio::io_context& io, std::string host, std::uint16_t port,
              ClientLimits limits = {});
  ~AsyncClient();
  void send(ClientRequest request, std::chrono::milliseconds answer_timeout, Callback callback);
  void close();

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace chorus::http
