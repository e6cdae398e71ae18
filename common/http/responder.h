// Decides, without a socket, how a request is answered, or what the connection has to do before
// that.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/rate_report.h"
#include "common/http/access.h"
#include "common/http/answer.h"
#include "common/http/live_reader.h"
#include "common/http/request_head.h"
#include "common/http/route_table.h"
#include "common/http/server.h"
#include "common/http/token_tries.h"

namespace chorus::http {

/// What the connection has to do with a request.
struct Reaction {
  enum class Kind {
    Answer,    ///< Send `answer`.
    ReadBody,  ///< Read content_length bytes, then call act().
    Wait,  ///< Call waited() after each publish of `entry`; after the time `wait`, call given_up().
    Stream,   ///< Send `answer`, then the events of `entry` until the client leaves.
    Upgrade,  ///< Hand the socket to a WebSocket connection for `entry` or, if set, `dialogue`.
  };
  Kind kind = Kind::Answer;
  Answer answer = {};
  const Router::Entry* entry = nullptr;
  const Action* action = nullptr;
  PathParams params = {};
  std::chrono::seconds wait{0};
  std::string_view event_type = {};  ///< For Stream: the media type of the events' data.
  LiveWish wish = {};                ///< For Stream, and for Upgrade without a dialogue.
  std::shared_ptr<Dialogue> dialogue = {};
  std::string protocol = {};  ///< For Upgrade: the chosen subprotocol; empty if there is none.

  [[nodiscard]] static Reaction of(Answer ready) {
    Reaction reaction;
    reaction.answer = std::move(ready);
    return reaction;
  }
};

class Responder {
 public:
  Responder(const ServerConfig& config, std::shared_ptr<const Router> router);

  [[nodiscard]] Reaction react(const RequestHead& head, const Peer& peer) const;
  [[nodiscard]] Answer act(const Reaction& reaction, const RequestHead& head, const Peer& peer,
                           std::string_view body) const;

  /// The answer to a long poll if the document has changed since the request's ETag; otherwise
  /// none.
  [[nodiscard]] std::optional<Answer> waited(const Router::Entry& entry,
                                             const RequestHead& head) const;
  /// The 304 that ends a long poll when nothing has changed.
  [[nodiscard]] Answer given_up(const Router::Entry& entry, const RequestHead& head) const;

  /// A problem document that refuses a request; the connection closes after it.
  [[nodiscard]] Answer refuse(const Refusal& refusal) const;

  /// True for a request whose path is vital: it is answered even beyond the limit of connections.
  [[nodiscard]] bool is_vital(const RequestHead& head) const;

  [[nodiscard]] const Router& router() const { return *router_; }

  void set_tokens(std::vector<Token> tokens) { guard_.tokens = std::move(tokens); }

 private:
  [[nodiscard]] Reaction read(const RequestHead& head, const Router::Match& match, const Peer& peer,
                              std::string_view path) const;
  void add_facts(Request& request, const RequestHead& head, const Peer& peer) const;
  [[nodiscard]] Reaction read_live(const RequestHead& head, const Router::Entry& entry) const;
  [[nodiscard]] Reaction upgrade(const RequestHead& head, const Router::Entry& entry) const;
  [[nodiscard]] Reaction converse(const RequestHead& head, const Router::Entry& entry,
                                  const Peer& peer) const;
  [[nodiscard]] Reaction write(const RequestHead& head, Router::Match match,
                               const Peer& peer) const;
  [[nodiscard]] std::optional<Answer> turn_down(const RequestHead& head, const Peer& peer,
                                                Role needed, std::string_view route) const;
  [[nodiscard]] std::optional<Answer> turn_away(const RequestHead& head, const Peer& peer,
                                                const Router::Entry* entry) const;
  [[nodiscard]] bool is_stranger(const RequestHead& head, const Peer& peer) const;
  [[nodiscard]] Reaction options(const std::string& route, std::string_view allowed) const;
  [[nodiscard]] Answer represent(const DocumentPtr& document, const RequestHead& head,
                                 std::string_view route) const;
  [[nodiscard]] Answer fault(const Error& error, const RequestHead& head,
                             std::string_view route) const;
  [[nodiscard]] std::string_view route_lines(const Router::Entry& entry) const;

  Guard guard_;
  bool secure_;  ///< True if all connections use TLS.
  std::string allowed_origin_;
  std::string challenge_;           ///< Header line of a 401.
  std::string reading_challenge_;   ///< The same for GET and HEAD, with Basic authentication added.
  std::vector<std::string> hosts_;  ///< The names of this service, for is_own_host().
  ServerLimits limits_;
  std::shared_ptr<const Router> router_;
  std::string any_route_;                 ///< Header lines of answers that belong to no route.
  std::vector<std::string> route_lines_;  ///< Header lines of each entry's answers.
  std::unique_ptr<RateReport> faults_;
  std::unique_ptr<RateReport> wrong_tokens_;
  std::unique_ptr<TokenTries> tries_;
};

}  // namespace chorus::http
