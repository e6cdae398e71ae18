// What a viewer can subscribe to: a topic, its schema, and the newest message on it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/time/timestamp.h"

namespace chorus::foxglove {

/// A message that is written when somebody first wants it.
class Message {
 public:
  Message(Timestamp at, std::function<std::string()> make) : at_(at), make_(std::move(make)) {}

  [[nodiscard]] Timestamp at() const { return at_; }
  [[nodiscard]] const std::string& text() const {
    const std::scoped_lock lock(mutex_);
    if (!text_) text_ = make_();
    return *text_;
  }

 private:
  Timestamp at_;
  std::function<std::string()> make_;
  mutable std::mutex mutex_;
  mutable std::optional<std::string> text_;
};

struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  std::string schema;  ///< Its name, of those in common/record.
  std::shared_ptr<const Message> newest = {};
  std::uint64_t version = 0;  ///< Counts the messages.
};

}  // namespace chorus::foxglove
