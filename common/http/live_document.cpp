#include "common/http/live_document.h"

#include <utility>

namespace chorus::http {

DocumentPtr LiveDocument::current() const {
  const std::lock_guard lock(mutex_);
  if (make_) {
    current_ = make_();
    make_ = nullptr;
  }
  return current_;
}

void LiveDocument::publish(DocumentPtr next) { replace(std::move(next), nullptr); }

void LiveDocument::publish_lazily(std::function<DocumentPtr()> make) {
  replace(nullptr, std::move(make));
}

void LiveDocument::replace(DocumentPtr next, std::function<DocumentPtr()> make) {
  std::shared_ptr<const Subscribers> to_tell;
  {
    const std::lock_guard lock(mutex_);
    current_.swap(next);  // `next` and `make` destroy what was there, outside the lock.
    make_.swap(make);
    to_tell = subscribers_;
  }
  for (const auto& on_change : *to_tell) on_change();
}

void LiveDocument::subscribe(std::function<void()> on_change) {
  const std::lock_guard lock(mutex_);
  Subscribers more = *subscribers_;
  more.push_back(std::move(on_change));
  subscribers_ = std::make_shared<const Subscribers>(std::move(more));
}

}  // namespace chorus::http
