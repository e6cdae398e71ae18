// Polls one resource of a running service, by long polling or at an interval, until stopped.
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
  std::uint64_t missed = 0;      ///< Frames that are missing in the sequence.
  std::uint64_t failed = 0;      ///< Requests that were refused or not answered.
  std::uint64_t unreadable = 0;  ///< Answers that are not a frame.
  std::uint64_t last = 0;        ///< The highest number, since the device began to count.
  std::string error;             ///< The last error, human-readable.

  /// A frame that was overtaken by others counts as missed only until it comes.
  void take(std::uint64_t sequence);
  void fail(const Error& why);
  void cannot_read(const Error& why);
};

class LivePoll {
 public:
  struct Options {
    std::string target;  ///< Such as "/frame".
    std::string accept = "text/turtle";
    /// Polls at this interval; zero: long polling instead.
    std::chrono::milliseconds every{0};
    tls::Trust trust = {};  ///< The authorities accepted for an https:// server.
  };
  /// Both functions are called on the thread of `io`.
  struct Takers {
    /// Called for each answer with status 200.
    std::function<void(const http::ClientResponse&)> answer;
    /// Called for a failure; status 0: there was no answer.  The request is then repeated after a
    /// moment.
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
