// Parses server-sent events from bytes as they arrive (WHATWG HTML 9.2.6), without a socket.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::http {

struct ServerEvent {
  std::string id;    ///< The last id given, by this event or an earlier one.
  std::string data;  ///< The data lines joined with line feeds; events without data are left out.

  bool operator==(const ServerEvent&) const = default;
};

class EventReader {
 public:
  explicit EventReader(std::size_t max_event_bytes) : most_(max_event_bytes) {}

  /// Returns the events that these bytes complete.  TooLarge when an event or a line exceeds the
  /// limit, or when twice as many bytes (comments, empty lines) bring no event; then do not read on
  /// from the stream.
  [[nodiscard]] Result<std::vector<ServerEvent>> take(std::string_view bytes);

 private:
  void end_line(std::string_view line, std::vector<ServerEvent>& out);
  void end_event(std::vector<ServerEvent>& out);

  std::size_t most_;
  std::string line_;  ///< The beginning of a line whose end has not come.
  std::string data_;
  std::size_t usual_ = 0;  ///< Bytes of the last event's data; the next has as many, or nearly.
  std::string id_;
  bool any_data_ = false;
  std::size_t since_event_ = 0;  ///< Bytes since the last event.
  /// The last byte was a carriage return; if a line feed follows, both end one line.
  bool after_return_ = false;
  bool at_begin_ = true;  ///< A byte order mark is skipped at the beginning only.
};

}  // namespace chorus::http
