#include "services/ctl/convert/fused_frames.h"

#include <csignal>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "common/client/live_poll.h"
#include "common/client/service_client.h"
#include "common/http/status.h"

namespace chorus::ctl {
namespace {

constexpr std::string_view kFusedTopic = "/frame";

/// Receives a server's frames for some time, each frame once, by conditional long polling.
class Listening {
 public:
  Listening(const http::Url& server, std::string source, tls::Trust trust, record::TakeFrame taker)
      : source_(std::move(source)),
        taker_(std::move(taker)),
        poll_(io_, server, {std::string(kFusedTopic), "application/json", {}, std::move(trust)},
              {[this](const http::ClientResponse& answer) { take(answer); },
               [this](const Error& error, int status) { failed(error, status); }}) {}

  /// Ctrl-C ends the listening early, and keeps what was heard.
  Result<record::Notes> run(std::chrono::milliseconds listen) {
    asio::signal_set signals(io_, SIGINT, SIGTERM);
    signals.async_wait([this](const net::error_code& error, int) {
      if (error) return;
      stopped_ = true;
      io_.stop();
    });
    poll_.start();
    io_.run_for(listen);
    poll_.stop();
    if (fatal_) return tl::unexpected<Error>(*fatal_);
    if (count_.frames == 0 && !count_.error.empty())
      return fail(ErrorCode::Unavailable, source_, "delivered no frame; " + count_.error);
    return notes();
  }

 private:
  void end_with(Error error) {
    error.context = source_;
    if (count_.frames == 0) fatal_ = std::move(error);
    io_.stop();
  }

  void take(const http::ClientResponse& answer) {
    const auto frame = record::read_fused_frame(answer.body, source_);
    if (!frame && frame.error().code == ErrorCode::Unsupported) return end_with(frame.error());
    if (!frame) return count_.cannot_read(frame.error());
    // A server without ETags may send the same frame again.
    if (count_.frames > 0 && frame->sequence == count_.last) return;
    if (auto taken = taker_(*frame, source_); !taken) {
      count_.cannot_read(taken.error());
      return end_with(taken.error());
    }
    count_.take(frame->sequence);
  }

  /// Gives up if no frame has come yet, unless the server says that it has none yet (503).
  void failed(const Error& error, int status) {
    count_.fail(error);
    if (count_.frames > 0 || status == http::status::kUnavailable) return;
    Error why = error;
    if (status == 0) why.message += "; is chorus-fusion running there?";
    end_with(std::move(why));
  }

  [[nodiscard]] record::Notes notes() const {
    record::Notes notes;
    if (stopped_) notes.emplace_back("stopped before --seconds had passed");
    if (count_.missed > 0) notes.push_back(fmt::format("{} frames were missed", count_.missed));
    if (count_.failed > 0) notes.push_back(fmt::format("{} requests failed", count_.failed));
    if (count_.unreadable > 0)
      notes.push_back(fmt::format("{} answers could not be used", count_.unreadable));
    if (!count_.error.empty()) notes.push_back("the last error: " + count_.error);
    return notes;
  }

  std::string source_;
  asio::io_context io_{1};
  record::TakeFrame taker_;
  client::LivePoll poll_;
  client::StreamCount count_;
  std::optional<Error> fatal_;
  bool stopped_ = false;
};

Result<record::Notes> listen_to(const std::string& source, std::chrono::milliseconds listen,
                                const record::TakeFrame& take) {
  auto url = http::parse_url(source);
  if (!url) return pass(url);
  std::string& path = url->target;
  while (path.ends_with('/')) path.pop_back();
  if (path.ends_with(kFusedTopic)) path.resize(path.size() - kFusedTopic.size());
  auto trust = client::authorities();
  if (!trust) return pass(trust);
  return Listening(*url, source, std::move(*trust), take).run(listen);
}

}  // namespace

Result<record::Notes> each_fused_frame(const std::string& source, std::chrono::milliseconds listen,
                                       const record::TakeFrame& take) {
  if (source.starts_with("http://") || source.starts_with("https://"))
    return listen_to(source, listen, take);
  return record::each_fused_frame(source, take);
}

}  // namespace chorus::ctl
