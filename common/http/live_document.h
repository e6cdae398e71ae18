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
  /// Publishes a document that `make` makes when it is first asked for.  Meant for what comes often
  /// and is rarely read, such as the frames of every sensor.  `make` must not use this
  /// LiveDocument.
  void publish_lazily(std::function<DocumentPtr()> make);

  /// `on_change` is called after each publish on the publisher's thread, so it should do no more
  /// than post a task.
  void subscribe(std::function<void()> on_change);

 private:
  using Subscribers = std::vector<std::function<void()>>;
  void replace(DocumentPtr next, std::function<DocumentPtr()> make);

  mutable std::mutex mutex_;
  mutable DocumentPtr current_;
  mutable std::function<DocumentPtr()> make_;  ///< Makes current_; empty once it is made.
  std::shared_ptr<const Subscribers> subscribers_ = std::make_shared<const Subscribers>();
};

}  // namespace chorus::http
