// Decides which handler answers which path.  It is filled at start and does not change while the
// server runs.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/http/dialogue.h"
#include "common/http/document.h"
#include "common/http/live_document.h"
#include "common/http/logged_events.h"
#include "common/http/static_files.h"

namespace chorus::http {

enum class Method { Get, Head, Options, Post, Put, Patch, Delete };

/// A request that passed the checks.  Views are valid during the call.
struct Request {
  Method method = Method::Get;
  std::string_view path;  ///< Percent-decoded, without query.
  /// Decoded; of a repeated key, the last value.
  std::map<std::string, std::string, std::less<>> query;
  std::map<std::string, std::string, std::less<>> headers;  ///< Lower-case names.
  std::string_view body;
  bool from_loopback = false;
  // Only for getters:
  /// By what the client reached `/`, "https://tracker.local:8080/"; empty if it named no host.
  std::string root = {};
  bool guards_reading = false;  ///< Whether reading needs a token, at least from other hosts.
  bool guards_writing = false;  ///< The same of writing.
};

/// The values that the {name} parts of the pattern have in the path.
using PathParams = std::map<std::string, std::string, std::less<>>;

/// A GET/HEAD handler: returns the resource as it is now.  It runs on the server's thread, so it
/// must be quick.  Errors become RFC 9457 problem documents.
using Getter = std::function<Result<DocumentPtr>(const Request&, const PathParams&)>;

/// The result of a writing method: status 200, 201 (with Location), 202 or 204, and the resource's
/// new document.
struct ActionResult {
  int status = 200;
  DocumentPtr document = {};  ///< Null: the answer has no body.
  std::string location = {};
};
using Action = std::function<Result<ActionResult>(const Request&, const PathParams&)>;

/// A pattern consists of literal segments and {name} segments; where both match, the literal one
/// wins. A trailing slash is significant (slash = container).  Asserts that no pattern gets the
/// same method twice.
class Router {
 public:
  Router();
  ~Router();
  Router(Router&&) noexcept;
  Router& operator=(Router&&) noexcept;

  void get(std::string pattern, Getter getter);
  /// GET/HEAD of a live document, with long polling by Prefer: wait and with event streams.
  void live(std::string pattern, std::shared_ptr<LiveDocument> document);
  /// Streams of a path that was given to live() send these messages instead of the document; it is
  /// to be published after each message.
  void logged(const std::string& pattern, std::shared_ptr<const LoggedEvents> log);
  /// On a path that was given to live(): GET/HEAD with ?key=... are answered by this getter
  /// instead.
  void by_query(const std::string& pattern, std::string key, Getter getter);
  /// A writing method; refuse_access() in access.h says which requests may use it.
  void action(Method method, std::string pattern, Action action);
  /// WebSockets whose clients send messages too.  Opening one needs DialogueRoute::role.
  void dialogue(const std::string& pattern, DialogueRoute route);
  /// GET/HEAD of the files in `folder` and below, never outside it; media types by extension.  The
  /// prefix ends in '/'.
  void files(std::string prefix, std::string folder, const FilesAre& about = {});

  /// Reading the pattern needs no token, even if reading everything else does.
  void for_everybody(const std::string& pattern);
  /// For monitors: the pattern is still answered when the limit of connections is reached.
  void vital(const std::string& pattern);
  /// For pictures and recordings: where reading needs a token, these need one of role Images or
  /// more; and a web page of another origin may read them only if exactly that origin is allowed
  /// ("*" is not enough).
  void shows_people(const std::string& pattern);

  struct Match;
  struct Entry;
  /// NotFound when no pattern fits the (decoded) path.
  [[nodiscard]] Result<Match> match(std::string_view path) const;
  [[nodiscard]] const std::vector<std::unique_ptr<Entry>>& entries() const { return entries_; }
  /// The entry of this pattern, whatever its {name} parts are called there; null: there is none.
  [[nodiscard]] const Entry* entry_like(std::string_view pattern) const;

 private:
  Entry& entry_of(const std::string& pattern);

  std::vector<std::unique_ptr<Entry>> entries_;
  std::map<std::string, Entry*, std::less<>> literal_;  ///< Patterns without {name}.
};

}  // namespace chorus::http
