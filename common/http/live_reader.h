// Which version of a live document one reader of a stream gets next: pure, time is an argument.
//
// Between two versions passes at least the time that the reader asked for with ?max_rate=.  Of the
// versions published meanwhile it gets the newest; none is queued.  Of logged events it gets each.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/duration.h"
#include "common/base/result.h"
#include "common/http/live_document.h"
#include "common/http/logged_events.h"
#include "common/http/request_head.h"
#include "common/http/route_table.h"

namespace chorus::http {

/// What a reader asks of a stream.
struct LiveWish {
  std::string form = {};     ///< Variant::profile of the documents; empty: the default.
  Duration interval{0};      ///< Least time between two documents; 0: as they come.
  std::string last_id = {};  ///< Version or event that the reader has already.
};

/// Of the query: `form` or `profile`, `max_rate` in Hz, from 0.1 to 1000, and `after`, which
/// Last-Event-ID replaces.  InvalidArgument for another rate.
[[nodiscard]] Result<LiveWish> live_wish_of(const RequestHead& head);

class LiveReader {
 public:
  /// `entry` must outlive the reader.
  LiveReader(const Router::Entry& entry, LiveWish wish);

  /// What to send as a server-sent event now; null: nothing.  `newest`: what to take for the newest
  /// version; null: what the entry has.
  [[nodiscard]] std::shared_ptr<const std::string> event(std::string_view media_type, Coding coding,
                                                         SteadyTime now,
                                                         DocumentPtr newest = nullptr);
  /// The same as a message in JSON.
  [[nodiscard]] std::shared_ptr<const std::string_view> message(SteadyTime now,
                                                                DocumentPtr newest = nullptr);

  /// Whether another one can be sent at once.
  [[nodiscard]] bool has_more() const;
  /// When the rate allows the version that waits; none: none waits.
  [[nodiscard]] std::optional<SteadyTime> held_until() const;

 private:
  [[nodiscard]] DocumentPtr next(SteadyTime now, DocumentPtr newest);
  [[nodiscard]] std::optional<LoggedEvents::One> next_logged();

  const Router::Entry* entry_;
  LiveWish wish_;
  DocumentPtr shown_;  ///< The last version that the reader got.
  std::uint64_t last_event_ = 0;
  SteadyTime not_before_{};
  bool held_ = false;
};

}  // namespace chorus::http
