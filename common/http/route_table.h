// What the router holds: one entry per pattern.  Read by the server only.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/http/router.h"
#include "common/http/static_files.h"

namespace chorus::http {

/// Everything that one pattern answers.
struct Router::Entry {
  std::string pattern;
  std::vector<std::string> segments;  ///< Between the slashes; "{name}" kept with its braces.
  std::size_t index = 0;              ///< The index of this entry in the router.

  Getter getter;
  std::shared_ptr<LiveDocument> live;
  std::string query_key;  ///< With `live`: requests with this key in their query ...
  Getter by_query;        ///< ... are answered here.
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
  std::string_view rest = {};  ///< What follows the prefix of files(); it points into the path.
};

/// "GET, HEAD, OPTIONS, POST": what an entry answers, for the Allow header.
[[nodiscard]] std::string allowed_methods(const Router::Entry& entry);

[[nodiscard]] std::string_view name_of(Method method) noexcept;

}  // namespace chorus::http
