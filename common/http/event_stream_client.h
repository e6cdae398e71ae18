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

/// Reads one stream at a time on its own connection; does not reconnect.  Callbacks come on the
/// io_context's thread, and all calls must be made there.  After the destructor or close(), no
/// callback comes.
class AsyncEventStream {
 public:
  struct Handlers {
    /// Gets the status, the fields and the time stamps of the answer's head, even if the answer is
    /// not an event stream.
    std::function<void(const ClientResponse&)> on_head;
    std::function<void(std::vector<ServerEvent>)> on_events;  ///< Never empty.
    /// The last call for a stream.  Unsupported: the answer is not an event stream.
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

  /// Opens a stream.  If one is open, it ends without a call of its on_end.
  void open(const ClientRequest& request, Handlers handlers);
  void close();

  /// Stops reading for `time` once the read under way is done; when the buffers fill meanwhile, the
  /// server skips events.
  void pause(std::chrono::milliseconds time);

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace chorus::http
