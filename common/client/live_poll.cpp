#include "common/client/live_poll.h"

#include <utility>

#include "common/client/service_client.h"
#include "common/http/status.h"

namespace chorus::client {
namespace {

constexpr std::chrono::seconds kAnswerWithin{8};  // The `wait` below, plus the network's delay.
constexpr const char* kWait = "wait=5";
constexpr std::chrono::milliseconds kAfterFailure{250};
// Pause for a resource that cannot wait: it answers with 304 at once, or has no ETag.
constexpr std::chrono::milliseconds kAfterNothing{10};
// A number that is farther below the newest one than this is no late frame: the device counts from
// the start again.
constexpr std::uint64_t kLateWithin = 100;

}  // namespace

void StreamCount::take(std::uint64_t sequence) {
  ++frames;
  if (frames > 1 && sequence < last && last - sequence <= kLateWithin) {
    if (missed > 0) --missed;  // It was counted as missed when a later one overtook it.
    return;
  }
  if (frames > 1 && sequence > last + 1) missed += sequence - last - 1;
  last = sequence;
}

void StreamCount::fail(const Error& why) {
  ++failed;
  error = to_string(why);
}

void StreamCount::cannot_read(const Error& why) {
  ++unreadable;
  error = to_string(why);
}

LivePoll::LivePoll(asio::io_context& io, const http::Url& base, Options options, Takers takers)
    : options_(std::move(options)),
      takers_(std::move(takers)),
      client_(io, base, {}, options_.trust),
      timer_(io) {
  std::string prefix = base.target;
  while (prefix.ends_with('/')) prefix.pop_back();
  options_.target = prefix + options_.target;
}

void LivePoll::stop() {
  stopped_ = true;
  client_.close();
  timer_.cancel();
}

void LivePoll::ask() {
  http::ClientRequest request;
  request.target = options_.target;
  request.headers = authorization();
  request.headers.emplace_back("Accept", options_.accept);
  if (!etag_.empty()) {
    request.headers.emplace_back("If-None-Match", etag_);
    if (options_.every.count() == 0) request.headers.emplace_back("Prefer", kWait);
  }
  client_.send(std::move(request), kAnswerWithin, [this](Result<http::ClientResponse> answer) {
    if (!stopped_) take(answer);
  });
}

void LivePoll::take(const Result<http::ClientResponse>& answer) {
  if (answer) answered_ = std::chrono::steady_clock::now();
  const bool failed = !answer || answer->status >= http::status::kBadRequest;
  if (failed) {
    takers_.failure(answer ? refusal_of(*answer, options_.target) : answer.error(),
                    answer ? answer->status : 0);
  }
  if (!failed && answer->status == http::status::kOk) deliver(*answer);
  if (stopped_) return;
  if (options_.every.count() > 0) return ask_after(options_.every);
  if (failed) return ask_after(kAfterFailure);
  if (answer->status == http::status::kOk && !etag_.empty()) return ask();
  ask_after(kAfterNothing);
}

void LivePoll::deliver(const http::ClientResponse& answer) {
  const auto etag = answer.headers.find("etag");
  etag_ = etag == answer.headers.end() ? std::string() : etag->second;
  takers_.answer(answer);
}

void LivePoll::ask_after(std::chrono::milliseconds pause) {
  timer_.expires_after(pause);
  timer_.async_wait([this](const net::error_code& error) {
    if (!error && !stopped_) ask();
  });
}

}  // namespace chorus::client
