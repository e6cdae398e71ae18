// Long-polls one resource of a running service: each version once, until stopped.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "common/http/client.h"
#include "common/net/asio.h"

namespace chorus::client {

/// Counts for a resource whose answers are numbered frames.
struct StreamCount {
  std::uint64_t frames = 0;
  std::uint64_t missed = 0;      ///< Gaps in the sequence.
  std::uint64_t failed = 0;      ///< Requests that were refused or got no answer.
  std::uint64_t unreadable = 0;  ///< Answers that are no frame.
  std::uint64_t last = 0;
  std::string error;  ///< Text of the last error.

  void take(std::uint64_t sequence);
  void fail(const Error& why);
  void cannot_read(const Error& why);
};

class LivePoll {
 public:
  struct Options {
    std::string target;  ///< "/frame"
    std::string accept = "text/turtle";
    /// Asks again at this interval; zero: uses long polling instead.
    std::chrono::milliseconds every{0};
    tls::Trust trust = {};  ///< Whom an https:// server must be certified by.
  };
  /// Both are called on the thread of `io`.
  struct Takers {
    std::function<void(const http::ClientResponse&)> answer;  ///< With status 200.
    /// Status 0: no answer at all.  In any case the request is repeated a moment later.
    std::function<void(const Error&, int status)> failure;
  };

  LivePoll(asio::io_context& io, const http::Url& base, Options options, Takers takers);

  void start() { ask(); }
  void stop();

  /// The time of the last answer of any kind.
  [[nodiscard]] std::chrono::steady_clock::time_point answered() const { return answered_; }

 private:
  void ask();
  void take(const Result<http::ClientResponse>& answer);
  void deliver(const http::ClientResponse& answer);
  void ask_after(std::chrono::milliseconds pause);

  Options options_;
  Takers takers_;
  http::AsyncClient client_;
  net::Timer timer_;
  std::string etag_;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point answered_ = std::chrono::steady_clock::now();
};

}  // namespace chorus::client
