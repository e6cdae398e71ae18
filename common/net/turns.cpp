#include "common/net/turns.h"

#include <utility>

namespace chorus::net {

void Turns::take(std::function<void()> task) {
  waiting_.push_back(std::move(task));
  if (waiting_.size() == 1) asio::post(io_, [this] { next(); });
}

/// The next turn is posted first, because the task may throw.
void Turns::next() {
  const std::function<void()> task = std::move(waiting_.front());
  waiting_.pop_front();
  if (!waiting_.empty()) asio::post(io_, [this] { next(); });
  task();
}

}  // namespace chorus::net
