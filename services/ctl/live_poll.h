// One resource of a running service, long-polled: each version once, for as long as it is wanted.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "common/http/asio.h"
#include "common/http/client.h"

namespace chorus::ctl {

class LivePoll {
 public:
  struct Options {
    std::string target;  ///< "/frame"
    std::string accept = "text/turtle";
    /// Not a long poll but asked anew so often; zero: long poll.
    std::chrono::milliseconds every{0};
  };
  using Deliver = std::function<void(const http::ClientResponse&)>;

  /// `deliver` gets answers with status 200, on the thread of `io`.  Failures are tried again.
  LivePoll(http::net::io_context& io, const http::Url& base, Options options, Deliver deliver);

  void start() { ask(); }
  void stop();

  /// Since when there has been no answer of any kind.
  [[nodiscard]] std::chrono::steady_clock::time_point answered() const { return answered_; }

 private:
  void ask();
  void take(const Result<http::ClientResponse>& answer);
  void ask_after(std::chrono::milliseconds pause);

  Options options_;
  Deliver deliver_;
  http::AsyncClient client_;
  http::Timer timer_;
  std::string etag_;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point answered_ = std::chrono::steady_clock::now();
};

}  // namespace chorus::ctl
