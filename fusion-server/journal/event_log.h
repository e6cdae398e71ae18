// The events of the last day, in a bounded ring.  A plain value without clock, thread or socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/duration.h"
#include "fusion-server/journal/event.h"

namespace chorus::journal {

struct LogLimits {
  std::size_t most = 2000;  ///< Events; with more, the oldest is dropped.
  Duration kept = std::chrono::hours(24);
  /// Events of one kind about one thing in a minute; the further ones are left out, so that one
  /// sensor with a loose plug does not push out all that happened to the others.
  int a_minute = 6;
};

class EventLog {
 public:
  /// Ids begin at `first`, which must be greater than every id of an earlier run.
  explicit EventLog(std::uint64_t first, LogLimits limits = {}) : limits_(limits), next_(first) {}

  /// Gives the event an id and keeps it; false if it was left out.
  bool add(Event event);
  /// Forgets what is older than LogLimits::kept.
  void age(Timestamp now);

  /// All that are kept, oldest first.
  [[nodiscard]] const std::deque<Event>& all() const { return events_; }
  /// The oldest event that is kept with an id greater than `id`; none: there is no such event.
  [[nodiscard]] std::optional<Event> after(std::uint64_t id) const;

 private:
  struct Rate {
    Timestamp minute;  ///< When it began.
    int count = 0;
  };

  LogLimits limits_;
  std::uint64_t next_;
  std::deque<Event> events_;
  std::map<std::string, Rate> rates_;  ///< By kind and what it is about.
};

}  // namespace chorus::journal
