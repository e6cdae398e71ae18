// A resource that changes: the current Document, and callbacks for when it is replaced.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "common/http/document.h"

namespace chorus::http {

/// Thread-safe.  Publishers replace the document; a server subscribes once, to wake its long polls.
class LiveDocument {
 public:
  /// Null until the first publish; until then the resource answers 503 with Retry-After.
  [[nodiscard]] DocumentPtr current() const;
  void publish(DocumentPtr next);

  /// `on_change` is called after each publish on the publisher's thread, so it should do no more
  /// than post a task.
  void subscribe(std::function<void()> on_change);

 private:
  mutable std::mutex mutex_;
  DocumentPtr current_;
  std::vector<std::function<void()>> subscribers_;
};

}  // namespace chorus::http
