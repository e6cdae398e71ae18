#include "common/http/responder.h"

#include <algorithm>

#include "common/http/conditional.h"
#include "common/http/handler_call.h"
#include "common/http/media_range.h"
#include "common/http/problem.h"
#include "common/http/route_lines.h"
#include "common/http/status.h"
#include "common/http/uri.h"
#include "common/http/websocket_handshake.h"

namespace chorus::http {
namespace {

constexpr std::string_view kEventStream = "text/event-stream";
constexpr std::string_view kAnyMethods = "GET, HEAD, POST, PUT, DELETE, OPTIONS";
constexpr std::string_view kJsonSuffix = ".json";
constexpr std::string_view kWaitApplied = "Preference-Applied: wait\r\n";

bool is_head(const RequestHead& head) { return head.method == Method::Head; }

/// True if the request prefers an event stream to a document: the stream must have the higher
/// quality, and a range must name it.
bool wants_events(const RequestHead& head, const Document& document) {
  const int events = explicit_quality_of(kEventStream, head.accept).value_or(0);
  if (events == 0) return false;
  for (const auto type : document.media_types()) {
    if (quality_of(type, head.accept).value_or(0) >= events) return false;
  }
  return true;
}

/// The media type of the events: JSON, unless Accept prefers Turtle.
std::string_view event_type_of(std::string_view accept) {
  constexpr std::string_view kJsonType = "application/json";
  constexpr std::string_view kTurtle = "text/turtle";
  const int turtle = explicit_quality_of(kTurtle, accept).value_or(0);
  return turtle > explicit_quality_of(kJsonType, accept).value_or(0) ? kTurtle : kJsonType;
}

/// X-Accel-Buffering: nginx and others collect an answer before they pass it on; events must not
/// wait for that.
constexpr std::string_view kStreamLines =
    "Content-Type: text/event-stream\r\nCache-Control: no-store\r\nX-Accel-Buffering: no\r\n\r\n";
constexpr std::string_view kStreamBegin = "retry: 1000\n\n";  // Browsers reconnect after 1 s.

std::string_view coded_stream_begin() {
  static const std::string begin = std::string(gzip_begin()) + gzip_piece(kStreamBegin);
  return begin;
}

/// Which form of a document is asked for: ?form=NAME or ?profile=NAME; they mean the same.
Result<std::string> profile_of(const RequestHead& head) {
  if (head.query.empty()) return std::string();
  auto query = decode_query(head.query);
  if (!query) return pass(query);
  const auto form = query->contains("form") ? query->find("form") : query->find("profile");
  return form == query->end() ? std::string() : form->second;
}

/// What the reader of a stream asks for; NotFound if the document has no such form in JSON or
/// Turtle, in which streams send it.
Result<LiveWish> wish_of(const RequestHead& head, const Document& document) {
  auto wish = live_wish_of(head);
  if (!wish || wish->form.empty()) return wish;
  const auto types = document.media_types(wish->form);
  if (std::ranges::find(types, "application/json") != types.end() ||
      std::ranges::find(types, "text/turtle") != types.end())
    return wish;
  return fail(ErrorCode::NotFound, "form",
              "this resource has no form \"" + wish->form + "\" that can be streamed");
}

/// True for a request like GET /frame?at=TIME, if the route has a getter for that key.
bool asks_by_query(const RequestHead& head, const Router::Entry& entry) {
  if (!entry.by_query || head.query.empty()) return false;
  const auto query = decode_query(head.query);
  return query && query->contains(entry.query_key);
}

/// True if the path ends in ".json" and no resource has that very name.  Ids of sensors and people
/// and names of recordings have no dot, so {id} at the end of a pattern is not meant to take one;
/// only {file} is.
bool asks_for_json(const Router& router, std::string_view path) {
  if (!path.ends_with(kJsonSuffix)) return false;
  const auto match = router.match(path);
  if (!match) return true;
  const std::string& pattern = match->entry->pattern;
  return pattern.ends_with('}') && !pattern.ends_with("{file}");
}

/// The Accept header; a path that ends in ".json" replaces it, for clients that cannot send one.
std::string_view accept_of(const RequestHead& head, const Router& router) {
  return asks_for_json(router, head.path) ? "application/json, */*;q=0.5" : head.accept;
}

/// The route for a path.  For a path that asks for JSON it is the route of the path without ".json"
/// or, if there is none, that of the container of this name ("sensors.json": "sensors/").
Result<Router::Match> named(const Router& router, std::string_view path) {
  if (!asks_for_json(router, path)) return router.match(path);
  const std::string_view plain = path.substr(0, path.size() - kJsonSuffix.size());
  auto match = router.match(plain);
  if (match) return match;
  auto container = router.match(std::string(plain) + "/");
  return container && !container->entry->files ? container : match;
}

/// The entry of the path that differs from this one only by a slash at the end; null if there is
/// none.
const Router::Entry* other_slash(std::string_view path, const Router& router) {
  const bool slash = path.ends_with('/');
  const std::string other =
      slash ? std::string(path.substr(0, path.size() - 1)) : std::string(path) + "/";
  if (path.size() < 2) return nullptr;
  const auto match = router.match(other);
  return match ? match->entry : nullptr;
}

/// For GET and HEAD, a redirection to the path that differs only by a slash at the end, if it is
/// known.
std::optional<Answer> redirected(const RequestHead& head, std::string_view path,
                                 const Router& router) {
  if (head.method != Method::Get && head.method != Method::Head) return std::nullopt;
  if (other_slash(path, router) == nullptr) return std::nullopt;
  const bool slash = path.ends_with('/');
  // The Location is relative, so it is correct behind any proxy, and stays percent-encoded, so
  // nothing is decoded twice.
  std::string_view last = head.path;
  if (slash) last.remove_suffix(1);
  last.remove_prefix(std::min(last.size(), last.rfind('/') + 1));
  Answer answer;
  answer.status = status::kPermanentRedirect;
  answer.extra = "Location: " + (slash ? "../" + std::string(last) : std::string(last) + "/");
  if (!head.query.empty()) answer.extra.append("?").append(head.query);
  answer.extra += "\r\n";
  answer.own = "Content-Length: 0\r\n\r\n";
  return answer;
}

}  // namespace

Responder::Responder(const ServerConfig& config, std::shared_ptr<const Router> router)
    : guard_{all_tokens(config.bearer_token, config.tokens), !is_loopback(config.address)},
      secure_(config.identity.has_value()),
      allowed_origin_(config.allowed_origin),
      challenge_("WWW-Authenticate: Bearer realm=\"" + config.policy.realm + "\"\r\n"),
      reading_challenge_(challenge_ + "WWW-Authenticate: Basic realm=\"" + config.policy.realm +
                         "\"\r\n"),
      hosts_(host_names()),
      limits_(config.limits),
      router_(std::move(router)),
      any_route_(common_lines(config)),
      faults_(std::make_unique<RateReport>("request failed", log::Level::Error)),
      wrong_tokens_(std::make_unique<RateReport>("wrong bearer token")),
      tries_(std::make_unique<TokenTries>()) {
  hosts_.insert(hosts_.end(), config.hosts.begin(), config.hosts.end());
  for (const auto& entry : router_->entries()) route_lines_.push_back(lines_of(config, *entry));
}

std::string_view Responder::route_lines(const Router::Entry& entry) const {
  return route_lines_[entry.index];
}

Reaction Responder::react(const RequestHead& head, const Peer& peer) const {
  if (!head.authority.empty() && !is_our_authority(head.authority, peer)) {
    return Reaction::of(
        refuse({status::kMisdirected, "this server is no proxy; ask it by its own address"}));
  }
  if (is_present(head.host) && !is_own_host(head.host, hosts_)) {
    return Reaction::of(refuse(
        {status::kMisdirected, "this service is not called " + std::string(head.host) +
                                   ": ask it by its address, or list the name under http.hosts"}));
  }
  if (head.asterisk) return options(any_route_, "GET, HEAD, OPTIONS");
  std::string storage;
  const auto path = decode_path(head.path, storage);
  if (!path) return Reaction::of(fault(path.error(), head, any_route_));
  auto match = named(*router_, *path);
  if (head.method == Method::Options && is_stranger(head, peer))
    return options(any_route_, kAnyMethods);
  const Router::Entry* entry = match ? match->entry : other_slash(*path, *router_);
  if (auto refused = turn_away(head, peer, entry)) return Reaction::of(std::move(*refused));
  if (!match) {
    auto elsewhere = redirected(head, *path, *router_);
    if (elsewhere) elsewhere->route = any_route_;
    return Reaction::of(elsewhere.value_or(fault(match.error(), head, any_route_)));
  }
  switch (head.method) {
    case Method::Options:
      return options(route_lines_[match->entry->index], allowed_methods(*match->entry));
    case Method::Get:
    case Method::Head:
      if (match->entry->dialogue && asks_for_websocket(head))
        return converse(head, *match->entry, peer);
      if (match->entry->live && !asks_by_query(head, *match->entry))
        return read_live(head, *match->entry);
      return read(head, *match, peer, *path);
    default:
      return write(head, std::move(*match), peer);
  }
}

/// True for a client that may not read without a token.  A browser's preflight from such a client
/// gets the same answer for every path.  A preflight normally comes without a token; if it has one,
/// the token is ignored, because the answer would reveal whether it is right.
bool Responder::is_stranger(const RequestHead& head, const Peer& peer) const {
  RequestHead anonymous = head;
  anonymous.authorization = {};
  return refuse_access(anonymous, peer, Role::Read, guard_).has_value();
}

bool Responder::is_vital(const RequestHead& head) const {
  std::string storage;
  const auto path = decode_path(head.path, storage);
  if (!path) return false;
  const auto match = router_->match(*path);
  return match && match->entry->vital;
}

Reaction Responder::options(const std::string& route, std::string_view allowed) const {
  Answer answer;
  answer.status = status::kNoContent;
  answer.route = route;
  if (&route == &any_route_) answer.extra.append("Allow: ").append(allowed).append("\r\n");
  answer.extra.append("Access-Control-Allow-Methods: ").append(allowed);
  answer.extra.append(
      "\r\nAccess-Control-Allow-Headers: Accept, Authorization, Content-Type, If-None-Match, "
      "Prefer, Last-Event-ID\r\nAccess-Control-Max-Age: 86400\r\n");
  answer.own = "\r\n";
  return Reaction::of(std::move(answer));
}

Reaction Responder::read(const RequestHead& head, const Router::Match& match, const Peer& peer,
                         std::string_view path) const {
  const Router::Entry& entry = *match.entry;
  const std::string_view route = route_lines(entry);
  if (!entry.readable())
    // An entry that cannot be read refuses GET like any other method that it lacks.
    return write(head, match, peer);
  const auto document = guarded<DocumentPtr>(head, [&]() -> Result<DocumentPtr> {
    if (entry.files) return entry.files->document(match.rest);
    auto request = request_of(head, peer, path);
    if (!request) return pass(request);
    add_facts(*request, head, peer);
    return (entry.live ? entry.by_query : entry.getter)(*request, match.params);
  });
  if (!document) return Reaction::of(fault(document.error(), head, route));
  return Reaction::of(represent(*document, head, route));
}

/// Tells a getter by what name the client reached us, and what clients need.  A proxy that we trust
/// says whether its client uses TLS.
void Responder::add_facts(Request& request, const RequestHead& head, const Peer& peer) const {
  request.guards_reading = guard_.guards_reading();
  request.guards_writing = request.guards_reading || !guard_.tokens.empty();
  if (head.host.empty()) return;
  const auto scheme = request.headers.find("x-forwarded-proto");
  const bool forwarded = peer.proxy && scheme != request.headers.end();
  const bool secure = forwarded ? scheme->second == "https" : secure_;
  request.root = (secure ? "https://" : "http://") + std::string(head.host) + "/";
}

Reaction Responder::read_live(const RequestHead& head, const Router::Entry& entry) const {
  if (asks_for_websocket(head)) return upgrade(head, entry);
  const DocumentPtr document = entry.live->current();
  if (document == nullptr || head.accept.empty() || !wants_events(head, *document)) {
    Reaction reaction = Reaction::of(represent(document, head, route_lines(entry)));
    const auto wait = wait_preference(head.prefer);
    if (!wait || !is_present(head.if_none_match)) return reaction;
    reaction.answer.extra.append(kWaitApplied);
    if (reaction.answer.status != status::kNotModified || wait->count() == 0) return reaction;
    reaction.kind = Reaction::Kind::Wait;
    reaction.entry = &entry;
    reaction.wait = std::min(*wait, limits_.max_wait);
    return reaction;
  }
  auto wish = wish_of(head, *document);
  if (!wish) return Reaction::of(fault(wish.error(), head, route_lines(entry)));
  Reaction reaction;
  reaction.kind = is_head(head) ? Reaction::Kind::Answer : Reaction::Kind::Stream;
  reaction.entry = &entry;
  reaction.wish = std::move(*wish);
  reaction.event_type = event_type_of(head.accept);
  reaction.answer.route = route_lines(entry);
  const bool coded = coding_for(head.accept_encoding) == Coding::Gzip;
  if (coded) reaction.answer.extra = "Content-Encoding: gzip\r\n";
  reaction.answer.own = kStreamLines;
  if (!is_head(head)) reaction.answer.body = coded ? coded_stream_begin() : kStreamBegin;
  reaction.answer.close = true;
  return reaction;
}

Reaction Responder::upgrade(const RequestHead& head, const Router::Entry& entry) const {
  if (!may_open(head, allowed_origin_)) {
    return Reaction::of(
        fault({ErrorCode::Forbidden, std::string(head.origin),
               "pages of this origin may not open a WebSocket here; see http.allowed_origin"},
              head, route_lines(entry)));
  }
  const DocumentPtr document = entry.live ? entry.live->current() : nullptr;
  auto wish = document ? wish_of(head, *document) : live_wish_of(head);
  if (!wish) return Reaction::of(fault(wish.error(), head, route_lines(entry)));
  Reaction reaction;
  reaction.kind = Reaction::Kind::Upgrade;
  reaction.entry = &entry;
  reaction.wish = std::move(*wish);
  return reaction;
}

std::optional<Answer> Responder::waited(const Router::Entry& entry, const RequestHead& head) const {
  Answer answer = represent(entry.live->current(), head, route_lines(entry));
  if (answer.status == status::kNotModified) return std::nullopt;
  answer.extra.append(kWaitApplied);
  return answer;
}

Answer Responder::given_up(const Router::Entry& entry, const RequestHead& head) const {
  Answer answer = represent(entry.live->current(), head, route_lines(entry));
  answer.extra.append(kWaitApplied);
  return answer;
}

Answer Responder::represent(const DocumentPtr& document, const RequestHead& head,
                            std::string_view route) const {
  if (document == nullptr)
    return fault({ErrorCode::Unavailable, std::string(head.path),
                  "there is nothing to show yet; ask again in a second"},
                 head, route);
  const auto profile = profile_of(head);
  if (!profile) return fault(profile.error(), head, route);
  const auto chosen =
      document->choose(accept_of(head, *router_), *profile, coding_for(head.accept_encoding));
  if (!chosen && chosen.error().code == ErrorCode::NotAcceptable) {
    Problem problem = problem_of(chosen.error());
    problem.available = document->media_types(*profile);
    return complaint(std::move(problem), head, route);
  }
  if (!chosen) return fault(chosen.error(), head, route);
  const Rendered& rendered = **chosen;
  Answer answer;
  answer.route = route;
  answer.owner = document;
  answer.captured = document->options().captured;
  if (!head.if_none_match.empty() && none_match_lists(head.if_none_match, rendered.etag)) {
    answer.status = status::kNotModified;
    answer.own = rendered.not_modified;
    return answer;
  }
  answer.own = rendered.head();
  if (is_head(head)) return answer;
  answer.body = rendered.body();
  answer.file = document->options().file;
  return answer;
}

Answer Responder::fault(const Error& error, const RequestHead& head, std::string_view route) const {
  if (error.code == ErrorCode::Internal) faults_->hit(to_string(error));
  Answer answer = complaint(problem_of(error), head, route);
  const bool reading = head.method == Method::Get || is_head(head);
  if (error.code == ErrorCode::Unauthorized)
    answer.extra = reading ? reading_challenge_ : challenge_;
  return answer;
}

Answer Responder::refuse(const Refusal& refusal) const {
  std::string_view code = name_of(ErrorCode::Malformed);
  if (refusal.status == status::kUnavailable) code = name_of(ErrorCode::Unavailable);
  if (refusal.status == status::kMisdirected) code = name_of(ErrorCode::Forbidden);
  Answer answer = problem_answer({refusal.status, code, {}, {}, refusal.detail}, false);
  answer.route = any_route_;
  answer.close = true;
  return answer;
}

}  // namespace chorus::http
