// A client of one event stream, on somebody's io_context.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/http/client.h"
#include "common/http/event_reader.h"

namespace chorus::http {

/// One stream at a time on a connection of its own.  Callbacks come on the io_context's thread, and
/// all calls must be made there.  Destroying it, or close(), cancels: no callback comes after that.
/// It does not reconnect.
class AsyncEventStream {
 public:
  struct Handlers {
    /// Status and fields of the answer, with the stamps of its head; an event stream or not.
    std::function<void(const ClientResponse&)> on_head;
    std::function<void(std::vector<ServerEvent>)> on_events;  ///< Never empty.
    /// Last call of a stream.  Unsupported: the answer is no event stream.
    std::function<void(Error)> on_end;
  };

  /// `limits.max_body_bytes` bounds one event; the time limits hold until the head has arrived.
  AsyncEventStream(boost::asio::io_context& io, std::string host, std::uint16_t port,
                   ClientLimits limits = {});
  ~AsyncEventStream();
  AsyncEventStream(const AsyncEventStream&) = delete;
  AsyncEventStream& operator=(const AsyncEventStream&) = delete;

  /// Ends the stream under way, if there is one.
  void open(const ClientRequest& request, Handlers handlers);
  void close();

  /// Stops reading for this long; the server has to wait and may skip events.
  void pause(std::chrono::milliseconds time);

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace chorus::http
