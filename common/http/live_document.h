// A resource that changes: the current Document, and all who wait for the next one.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "common/http/document.h"

namespace chorus::http {

/// Thread-safe.  Publishers replace the document; servers subscribe once and wake their long polls.
class LiveDocument {
 public:
  /// Null until the first publish: the resource answers 503 with Retry-After.
  [[nodiscard]] DocumentPtr current() const;
  void publish(DocumentPtr next);

  /// `on_change` is called after each publish, on the publisher's thread; it must only post.
  void subscribe(std::function<void()> on_change);

 private:
  mutable std::mutex mutex_;
  DocumentPtr current_;
  std::vector<std::function<void()>> subscribers_;
};

}  // namespace chorus::http
