// What happened, message by message: a stream sends each of them once and in order, unlike the
// versions of a LiveDocument, of which the newest replaces those before it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace chorus::http {

/// Thread-safe.
class LoggedEvents {
 public:
  struct One {
    std::uint64_t id = 0;  ///< The reader sends it back as Last-Event-ID.
    std::string json;
  };

  virtual ~LoggedEvents() = default;
  /// The oldest message that is kept with an id greater than `id`; none: there is no such message.
  [[nodiscard]] virtual std::optional<One> after(std::uint64_t id) const = 0;
};

}  // namespace chorus::http
