#include "common/http/live_document.h"

#include <utility>

namespace chorus::http {

DocumentPtr LiveDocument::current() const {
  const std::lock_guard lock(mutex_);
  return current_;
}

void LiveDocument::publish(DocumentPtr next) {
  std::vector<std::function<void()>> to_tell;
  {
    const std::lock_guard lock(mutex_);
    current_.swap(next);  // `next` destroys the old document, outside the lock.
    to_tell = subscribers_;
  }
  for (const auto& on_change : to_tell) on_change();
}

void LiveDocument::subscribe(std::function<void()> on_change) {
  const std::lock_guard lock(mutex_);
  subscribers_.push_back(std::move(on_change));
}

}  // namespace chorus::http
