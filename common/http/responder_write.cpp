// The HTTP methods that write: who may use them, how much they may send, and how the action's
// result is answered.
#include "common/http/handler_call.h"
#include "common/http/responder.h"
#include "common/http/status.h"
#include "common/http/uri.h"
#include "common/http/websocket_handshake.h"

namespace chorus::http {
namespace {

/// The answer with the document that an action returned, or without a body.
Result<Answer> answer_of(const ActionResult& done, std::string_view accept) {
  Answer answer;
  answer.status = done.status;
  if (!done.location.empty()) answer.extra = "Location: " + done.location + "\r\n";
  answer.own = done.status == status::kNoContent ? "\r\n" : "Content-Length: 0\r\n\r\n";
  if (done.status == status::kNoContent || !done.document) return answer;
  // The action has been done: a client that accepts none of our types gets the default, not an
  // error.
  auto chosen = done.document->choose(accept);
  if (!chosen) chosen = done.document->choose("");
  if (!chosen) return pass(chosen);
  answer.own = (*chosen)->head();
  answer.body = (*chosen)->body();
  answer.owner = done.document;
  return answer;
}

/// A request for a dialogue.  Browsers cannot send Authorization with a WebSocket, so the token may
/// come as a subprotocol.
struct Asking {
  Asking(const RequestHead& as_sent, const Router::Entry& entry)
      : offered(subprotocols_of(as_sent, entry.dialogue->protocol)),
        bearer("Bearer " + offered.token),
        head(as_sent) {
    if (!offered.token.empty() && !is_present(head.authorization)) head.authorization = bearer;
  }
  Asking(const Asking&) = delete;
  Asking& operator=(const Asking&) = delete;

  Subprotocols offered;
  std::string bearer;
  RequestHead head;  ///< Points into the members above.
};

}  // namespace

/// The answer that refuses this request; none when the request may do what it needs.  Every token
/// is looked at; after many wrong ones from one address, the answer to the next wrong one waits.
std::optional<Answer> Responder::turn_down(const RequestHead& head, const Peer& peer, Role needed,
                                           std::string_view route) const {
  const auto refused = refuse_access(head, peer, needed, guard_);
  if (!refused) return std::nullopt;
  Answer answer = fault(*refused, head, route);
  if (has_wrong_token(head, guard_)) {
    answer.delay =
        tries_->note_wrong(peer.account, head.authorization, std::chrono::steady_clock::now());
    wrong_tokens_->hit(peer.account);
  }
  return answer;
}

/// Where reading needs a token, refuses a client without the right one, whether or not the path
/// exists, so that the client does not learn which paths do.
std::optional<Answer> Responder::turn_away(const RequestHead& head, const Peer& peer,
                                           const Router::Entry* entry) const {
  const bool for_everybody = entry != nullptr && entry->for_everybody;
  if (for_everybody || head.method == Method::Options || !guard_.guards_reading())
    return std::nullopt;
  const bool reads = head.method == Method::Get || head.method == Method::Head;
  const Role to_read = entry != nullptr && entry->shows_people ? Role::Images : Role::Read;
  const Role needed = reads ? to_read : Role::Control;
  if (entry == nullptr || !entry->dialogue) return turn_down(head, peer, needed, any_route_);
  const Asking asking(head, *entry);
  return turn_down(asking.head, peer, needed, any_route_);
}

Reaction Responder::write(const RequestHead& head, Router::Match match, const Peer& peer) const {
  const std::string_view route = route_lines(*match.entry);
  const auto action = match.entry->actions.find(head.method);
  if (action == match.entry->actions.end()) {
    const std::string detail =
        "this resource answers " + allowed_methods(*match.entry) + " and no other method";
    return Reaction::of(
        complaint({status::kMethodNotAllowed, "unsupported", {}, {}, detail}, head, route));
  }
  if (auto refused = turn_down(head, peer, Role::Control, route))
    return Reaction::of(std::move(*refused));
  if (head.content_length > limits_.max_body_bytes)
    return Reaction::of(fault({ErrorCode::TooLarge, "Content-Length",
                               "send at most " + std::to_string(limits_.max_body_bytes) + " bytes"},
                              head, route));
  Reaction reaction;
  reaction.kind = Reaction::Kind::ReadBody;
  reaction.entry = match.entry;
  reaction.action = &action->second;
  reaction.params = std::move(match.params);
  return reaction;
}

/// Opens a WebSocket for a dialogue, or refuses it.
Reaction Responder::converse(const RequestHead& head, const Router::Entry& entry,
                             const Peer& peer) const {
  const std::string_view route = route_lines(entry);
  if (!may_open(head, allowed_origin_)) return upgrade(head, entry);
  const Asking asking(head, entry);
  if (auto refused = turn_down(asking.head, peer, entry.dialogue->role, route))
    return Reaction::of(std::move(*refused));
  auto begun =
      guarded<std::unique_ptr<Dialogue>>(head, [&] { return entry.dialogue->open(peer.account); });
  if (!begun) return Reaction::of(fault(begun.error(), head, route));
  Reaction reaction;
  reaction.kind = Reaction::Kind::Upgrade;
  reaction.entry = &entry;
  reaction.dialogue = std::move(*begun);
  if (asking.offered.named) reaction.protocol = entry.dialogue->protocol;
  return reaction;
}

Answer Responder::act(const Reaction& reaction, const RequestHead& head, const Peer& peer,
                      std::string_view body) const {
  const std::string_view route = route_lines(*reaction.entry);
  const auto done = guarded<ActionResult>(head, [&]() -> Result<ActionResult> {
    std::string storage;
    const auto path = decode_path(head.path, storage);
    if (!path) return pass(path);
    auto request = request_of(head, peer, *path);
    if (!request) return pass(request);
    request->body = body;
    return (*reaction.action)(*request, reaction.params);
  });
  if (!done) {
    Answer answer = fault(done.error(), head, route);
    answer.close = false;  // The request's body has been read.
    return answer;
  }
  auto answer = answer_of(*done, head.accept);
  if (!answer) return fault(answer.error(), head, route);
  answer->route = route;
  return std::move(*answer);
}

}  // namespace chorus::http
