#include "common/net/every.h"

#include <utility>

namespace chorus::net {

Every::Every(asio::io_context& io, std::chrono::milliseconds interval, std::function<void()> work)
    : timer_(io.get_executor()), interval_(interval), work_(std::move(work)) {}

void Every::ensure() {
  if (under_way_ || stopped_) return;
  timer_.expires_after(interval_);
  timer_.async_wait([this](error_code cancelled) {
    under_way_ = false;
    // Cancelling does not stop a handler that is already due.
    if (cancelled || stopped_) return;
    ensure();  // Before work_(), so that an exception from it does not end the series.
    work_();
  });
  under_way_ = true;
}

void Every::stop() {
  stopped_ = true;
  timer_.cancel();
}

}  // namespace chorus::net
