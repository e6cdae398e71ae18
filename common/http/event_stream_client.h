// A client of one event stream, on the caller's io_context.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/http/client.h"
#include "common/http/event_reader.h"

namespace chorus::http {

/// One stream at a time on its own connection.  Callbacks come on the io_context's thread, and all
/// calls must be made there.  The destructor and close() cancel: no callback comes after that. It
/// does not reconnect.
class AsyncEventStream {
 public:
  struct Handlers {
    /// Status, fields and time stamps of the answer's head, even if it is no event stream.
    std::function<void(const ClientResponse&)> on_head;
    std::function<void(std::vector<ServerEvent>)> on_events;  ///< Never empty.
    /// The last call for a stream.  Unsupported: the answer is no event stream.
    std::function<void(Error)> on_end;
  };

  /// `limits.max_body_bytes` bounds one event; the time-outs apply until the head has arrived.
  AsyncEventStream(boost::asio::io_context& io, std::string host, std::uint16_t port,
                   ClientLimits limits = {});
  /// Uses the URL's host, port and scheme, but not its target.
  AsyncEventStream(boost::asio::io_context& io, const Url& url, ClientLimits limits = {},
                   const tls::Trust& trust = {});
  ~AsyncEventStream();
  AsyncEventStream(const AsyncEventStream&) = delete;
  AsyncEventStream& operator=(const AsyncEventStream&) = delete;

  /// Ends the current stream, if there is one.
  void open(const ClientRequest& request, Handlers handlers);
  void close();

  /// Stops reading for this long; the server then has to wait and may skip events.
  void pause(std::chrono::milliseconds time);

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace chorus::http
