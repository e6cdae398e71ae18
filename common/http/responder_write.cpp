// Writing methods: who may, how much, and what the action did.
#include "common/http/handler_call.h"
#include "common/http/responder.h"
#include "common/http/uri.h"

namespace chorus::http {
namespace {

/// The resource that an action answers with, or that there is none.
Result<Answer> answer_of(const ActionResult& done, std::string_view accept) {
  Answer answer;
  answer.status = done.status;
  if (!done.location.empty()) answer.extra = "Location: " + done.location + "\r\n";
  constexpr int kNoContent = 204;
  answer.own = done.status == kNoContent ? "\r\n" : "Content-Length: 0\r\n\r\n";
  if (done.status == kNoContent || !done.document) return answer;
  // It is done: a client that accepts nothing of ours gets the default rather than an error.
  auto chosen = done.document->choose(accept);
  if (!chosen) chosen = done.document->choose("");
  if (!chosen) return pass(chosen);
  answer.own = (*chosen)->head();
  answer.body = (*chosen)->body();
  answer.owner = done.document;
  return answer;
}

}  // namespace

/// What says that this request may not write; nothing when it may.
std::optional<Answer> Responder::turn_down(const RequestHead& head, const Peer& peer,
                                           std::string_view route) const {
  const auto now = std::chrono::steady_clock::now();
  const bool tries = !bearer_token_.empty() && is_present(head.authorization);
  if (tries && !tries_->may_try(peer.account, now)) {
    constexpr int kTooManyRequests = 429;
    const std::string detail =
        "too many wrong tokens came from your address; try again in a second";
    Answer answer = complaint({kTooManyRequests, name_of(ErrorCode::Unauthorized), {}, {}, detail},
                              head, route);
    answer.extra = "Retry-After: 1\r\n";
    return answer;
  }
  const auto refused = refuse_writing(head, peer, bearer_token_);
  if (!refused) return std::nullopt;
  if (tries) {
    tries_->note_wrong(peer.account, now);
    wrong_tokens_->hit(peer.account);
  }
  return fault(*refused, head, route);
}

Reaction Responder::write(const RequestHead& head, Router::Match match, const Peer& peer) const {
  const std::string_view route = route_lines(*match.entry);
  const auto action = match.entry->actions.find(head.method);
  if (action == match.entry->actions.end()) {
    constexpr int kMethodNotAllowed = 405;
    const std::string detail =
        "this resource answers " + allowed_methods(*match.entry) + " and no other method";
    return Reaction::of(complaint({kMethodNotAllowed, "unsupported", {}, {}, detail}, head, route));
  }
  if (auto refused = turn_down(head, peer, route)) return Reaction::of(std::move(*refused));
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
    answer.close = false;  // The body has been read.
    return answer;
  }
  auto answer = answer_of(*done, head.accept);
  if (!answer) return fault(answer.error(), head, route);
  answer->route = route;
  return std::move(*answer);
}

}  // namespace chorus::http
