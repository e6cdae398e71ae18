#include "common/http/conversation.h"

#include <utility>

#include "common/base/log.h"
#include "common/http/admission.h"
#include "common/http/route_table.h"
#include "common/http/status.h"
#include "common/http/websocket_handshake.h"

namespace chorus::http {
namespace {

constexpr std::chrono::seconds kLingerTime{2};
constexpr std::chrono::milliseconds kHeldFor{100};
constexpr std::size_t kLingerBytes = 1u << 20;  // How much is still read after the last answer.

// The client sends the body only after it has read this.
constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

/// Logs a request, for debugging (log.level "debug"), without query and fields, because these may
/// contain secrets.
void note(const RequestHead& head, const Peer& peer, int status) {
  if (!log::is_wanted(log::Level::Debug)) return;
  log::debug("request", {{"method", name_of(head.method)},
                         {"path", head.path},
                         {"status", status},
                         {"from", peer.account}});
}

}  // namespace

Conversation::Conversation(ConversationContext context, Peer peer, Charge charge)
    : context_(context),
      peer_(std::move(peer)),
      charge_(std::move(charge)),
      buffer_(context.config.limits.max_header_bytes),
      download_(context.counters.downloads_open) {}

template <class Event>
Orders Conversation::resume(SteadyTime now, const Event& event) {
  now_ = now;
  orders_ = {};
  if (!closed()) event();
  return std::exchange(orders_, {});
}

Orders Conversation::begin(SteadyTime now) {
  return resume(now, [this] {
    expire_in(context_.config.limits.idle_timeout);
    read();
  });
}

Orders Conversation::begin_in_reserve(SteadyTime now) {
  return resume(now, [this] {
    in_reserve_ = close_after_ = true;
    expire_in(context_.config.limits.header_timeout);
    read();
  });
}

Orders Conversation::received(std::size_t size, SteadyTime now) {
  return resume(now, [this, size] { on_input(size); });
}

Orders Conversation::input_ended(bool cleanly, SteadyTime now) {
  return resume(now, [this, cleanly] {
    reading_ = false;
    end_of_input_ = true;
    // After a clean end, the answer under way is finished, and requests that are in the buffer
    // already are answered.  A request that is incomplete, waits or streams is dropped.
    if (!cleanly || state_ != State::Writing) hang_up();
  });
}

Orders Conversation::sent(std::size_t size, SteadyTime now) {
  return resume(now, [this, size] {
    if (std::exchange(continuing_, false)) return advance_body();
    count(context_.counters.bytes_sent, size);
    if (state_ != State::Streaming) return answer_sent();
    event_.reset();
    orders_.settle = true;
  });
}

Orders Conversation::send_failed(std::size_t size, SteadyTime now) {
  return resume(now, [this, size] {
    if (!continuing_) count(context_.counters.bytes_sent, size);
    hang_up();
  });
}

Orders Conversation::settled(SteadyTime now) {
  return resume(now, [this] { on_settled(); });
}

Orders Conversation::woken(SteadyTime now) {
  return resume(now, [this] { on_woken(); });
}

Orders Conversation::look(SteadyTime now, DocumentPtr newest) {
  return resume(now, [&] { on_look(std::move(newest)); });
}

Orders Conversation::expired(SteadyTime now) {
  return resume(now, [this] { on_deadline(); });
}

Orders Conversation::stop(SteadyTime now) {
  return resume(now, [this] { on_stop(); });
}

Orders Conversation::close(SteadyTime now) {
  return resume(now, [this] { hang_up(); });
}

bool Conversation::idle() const {
  return state_ == State::Head && unread().empty() && !in_reserve_;
}

void Conversation::read() {
  if (reading_ || buffer_.full()) return;
  orders_.read = reading_ = true;
}

void Conversation::on_input(std::size_t size) {
  reading_ = false;
  buffer_.add(size);
  switch (state_) {
    case State::Head:
      received_ = context_.config.clock->now();
      if (unread().size() == size) expire_in(context_.config.limits.header_timeout);
      return advance();
    case State::Body:
      return advance_body();
    case State::Lingering:
      drained_ += size;
      buffer_.clear();
      return drained_ > kLingerBytes ? hang_up() : read();
    default:
      return;  // The client has sent a request ahead; it stays in the buffer.
  }
}

void Conversation::advance() {
  const HeadEnd head = buffer_.find_head();
  if (head.progress == HeadProgress::Broken) {
    return refuse(status::kBadRequest,
                  "lines end in CR LF and a request begins with its request line");
  }
  if (head.progress == HeadProgress::Complete) return serve(head.size);
  if (!reading_) buffer_.compact();
  if (buffer_.full()) {
    const bool line_done = unread().find('\n') != std::string_view::npos;
    return refuse(line_done ? status::kFieldsTooLarge : status::kUriTooLong,
                  "a request line with its header fields has at most " +
                      std::to_string(buffer_.capacity()) + " bytes");
  }
  read();
}

void Conversation::refuse(int status, std::string detail) {
  count(context_.counters.refused);
  send(context_.responder.refuse({status, std::move(detail)}));
}

void Conversation::serve(std::size_t head_size) {
  request_size_ = head_size;
  if (auto refusal = read_head(unread().substr(0, head_size), head_))
    return refuse(refusal->status, std::move(refusal->detail));
  count(context_.counters.requests);
  if (!head_.keep_alive) close_after_ = true;
  if (!may_ask()) return refuse(status::kUnavailable, "too many connections; keep fewer open");
  answer();
}

/// Answers the request in the buffer, or holds it for a moment if its address has asked too much.
void Conversation::answer() {
  const bool limited = context_.allowance != nullptr && !is_exempt();
  if (limited && !context_.allowance->take(peer_.account, now_)) {
    if (state_ != State::Held) count(context_.counters.held);
    state_ = State::Held;
    deadline_ = now_ + kHeldFor;
    return;
  }
  if (expects_tls_)
    return refuse(status::kBadRequest,
                  "this port speaks TLS only; ask the same address with https://");
  reaction_ = context_.responder.react(head_, peer_);
  if (reaction_.kind != Reaction::Kind::ReadBody) note(head_, peer_, reaction_.answer.status);
  switch (reaction_.kind) {
    case Reaction::Kind::Answer:
      return send(std::move(reaction_.answer));
    case Reaction::Kind::ReadBody:
      return begin_body();
    case Reaction::Kind::Wait:
      return begin_wait();
    case Reaction::Kind::Stream:
      return begin_stream();
    case Reaction::Kind::Upgrade:
      state_ = State::Closed;
      orders_.upgrade = true;
  }
}

std::string Conversation::handshake() const {
  return handshake_of(head_, unread().substr(request_size_));
}

/// True for programs on this host itself.  Where a proxy is configured, whoever comes from this
/// host may be anybody.
bool Conversation::is_exempt() const {
  return peer_.loopback && !peer_.proxy && context_.config.trusted_proxies.empty();
}

/// True if this request is within the limits of its sender, or if its path is vital.
bool Conversation::may_ask() {
  if (peer_.proxy) {
    if (const auto account = forwarded_account(head_)) {
      if (!charge_(*account)) return context_.responder.is_vital(head_);
      peer_.account = *account;
    }
  }
  return !in_reserve_ || context_.responder.is_vital(head_);
}

void Conversation::begin_body() {
  state_ = State::Body;
  body_.clear();
  expire_in(context_.config.limits.body_timeout);
  if (!head_.expects_continue) return advance_body();
  continuing_ = true;
  write(kContinue);
}

void Conversation::advance_body() {
  // The head stays in the buffer, because the action reads it; only the body is moved out.
  const auto wanted = static_cast<std::size_t>(head_.content_length) - body_.size();
  buffer_.take_body(request_size_, wanted, body_);
  if (body_.size() < head_.content_length) {
    // A head that fills the buffer leaves no room for reading the body.
    if (buffer_.full())
      return refuse(status::kFieldsTooLarge, "shorten the header fields of a request with a body");
    return read();
  }
  Answer answer = context_.responder.act(reaction_, head_, peer_, body_);
  note(head_, peer_, answer.status);
  send(std::move(answer));
}

void Conversation::send(Answer answer) {
  if (answer.file && !download_.begin(context_.config.limits.max_downloads)) {
    count(context_.counters.refused);
    answer = context_.responder.refuse(
        {status::kUnavailable,
         "too many files are on their way to others; ask again when one is done"});
  }
  answer_ = std::move(answer);
  if (answer_.delay > Duration{0} && !context_.stopping) {
    state_ = State::Delayed;
    deadline_ = now_ + answer_.delay;
    return;
  }
  send_now();
}

void Conversation::send_now() {
  state_ = State::Writing;
  close_after_ = close_after_ || answer_.close || context_.stopping;
  if (answer_.status == status::kNotModified) count(context_.counters.not_modified);
  if (answer_.status == status::kUnauthorized || answer_.status == status::kTooManyRequests)
    count(context_.counters.unauthorized);
  first_lines_.clear();
  const bool tell = head_.minor_version == 0 && !close_after_;
  write_first_lines(first_lines_, answer_,
                    {received_, context_.config.clock->now(), close_after_, tell,
                     context_.config.policy.clock_field});
  write(first_lines_);
  output_ = {first_lines_, answer_.route, answer_.own, answer_.body};
}

void Conversation::write(std::string_view bytes) {
  output_ = {bytes};
  orders_.write = true;
  if (!continuing_) expire_in(context_.config.limits.write_timeout);
}

void Conversation::answer_sent() {
  if (send_piece()) return;
  answer_ = {};
  download_.end();
  if (reaction_.kind == Reaction::Kind::Stream) {
    state_ = State::Streaming;
    return push_event();
  }
  if (close_after_ || context_.stopping) return linger();
  next_request();
}

/// Sends the next piece of the answer's file; false when none is left.
bool Conversation::send_piece() {
  if (!answer_.file || download_.complete(*answer_.file)) return false;
  if (!download_.read_next(*answer_.file)) {
    hang_up();  // The file became too short for the announced length; hanging up is the only way to
                // say so.
    return true;
  }
  write(download_.piece());
  return true;
}

void Conversation::next_request() {
  buffer_.drop(request_size_);
  request_size_ = 0;
  reaction_.entry = nullptr;
  state_ = State::Head;
  if (unread().empty()) {
    if (!reading_) buffer_.clear();
    expire_in(context_.config.limits.idle_timeout);
    return end_of_input_ ? hang_up() : read();
  }
  received_ = context_.config.clock->now();
  expire_in(context_.config.limits.header_timeout);
  advance();
}

/// Shuts down sending and goes on reading for a while, or until the client has closed: closing with
/// unread input would reset the connection, and the client might not get the answer.
void Conversation::linger() {
  if (end_of_input_) return hang_up();
  state_ = State::Lingering;
  if (!reading_) buffer_.clear();
  orders_.half_close = true;
  expire_in(kLingerTime);
  read();
}

void Conversation::on_deadline() {
  switch (state_) {
    case State::Head:
      if (unread().empty()) return hang_up();
      return refuse(status::kRequestTimeout, "the request did not arrive in time; send it at once");
    case State::Body:
      if (continuing_) return hang_up();
      return refuse(status::kRequestTimeout, "the request did not arrive in time; send it at once");
    case State::Waiting:
      orders_.stop_waiting = true;
      return end_wait(context_.responder.given_up(*reaction_.entry, head_));
    case State::Streaming:
      return push_event();
    case State::Held:
      return answer();
    case State::Delayed:
      return send_now();
    default:
      return hang_up();
  }
}

void Conversation::on_stop() {
  switch (state_) {
    case State::Waiting:
      orders_.stop_waiting = true;
      return end_wait(context_.responder.refuse({status::kUnavailable, "the service is stopping"}));
    case State::Writing:
    case State::Body:
      return;
    default:
      return hang_up();
  }
}

void Conversation::hang_up() {
  const State before = std::exchange(state_, State::Closed);
  download_.end();
  if (before == State::Waiting) uncount(context_.counters.long_polls_waiting);
  if (reaction_.kind == Reaction::Kind::Stream) uncount(context_.counters.event_streams_open);
  orders_.stop_waiting = reaction_.entry != nullptr;
  orders_.close = true;
}

}  // namespace chorus::http
