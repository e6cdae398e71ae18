// What the router holds: one entry per pattern.  The server reads it, and what describes a service.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/http/logged_events.h"
#include "common/http/router.h"
#include "common/http/static_files.h"

namespace chorus::http {

/// Everything that one pattern answers.
struct Router::Entry {
  std::string pattern;
  std::vector<std::string> segments;  ///< The parts between the slashes; "{name}" keeps its braces.
  std::size_t index = 0;              ///< The index of this entry in the router.

  Getter getter;
  std::shared_ptr<LiveDocument> live;
  std::shared_ptr<const LoggedEvents> log;  ///< With `live`: what its streams send.
  /// With `live`: requests whose query has this key are answered by `by_query`.
  std::string query_key;
  Getter by_query;  ///< Answers the requests whose query has `query_key`.
  std::map<Method, Action> actions;
  std::optional<DialogueRoute> dialogue;  ///< Answers WebSockets.
  bool vital = false;                     ///< See Router::vital.
  bool for_everybody = false;             ///< See Router::for_everybody.
  bool shows_people = false;              ///< See Router::shows_people.
  std::unique_ptr<StaticFiles> files;     ///< If set, the pattern is a prefix.

  [[nodiscard]] bool readable() const { return getter || live || files; }
};

struct Router::Match {
  const Entry* entry = nullptr;
  PathParams params = {};
  std::string_view rest = {};  ///< For files(): what follows the prefix; points into the path.
};

/// "GET, HEAD, OPTIONS, POST": what an entry answers, for the Allow header.
[[nodiscard]] std::string allowed_methods(const Router::Entry& entry);

[[nodiscard]] std::string_view name_of(Method method) noexcept;

}  // namespace chorus::http
