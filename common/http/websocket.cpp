#include "common/http/websocket.h"

#include <optional>
#include <utility>

#include "common/http/access.h"
#include "common/http/beast_websocket.h"
#include "common/http/server_core.h"
#include "common/http/text.h"
#include "common/http/uri.h"
#include "common/net/small_queue.h"

namespace chorus::http {
namespace {

namespace websocket = boost::beast::websocket;

constexpr std::size_t kMaxSaid = 4096;  ///< Bytes of one message from a client.
/// Beast ends a broken or closed conversation by waiting for the client to hang up; we check this
/// often whether one is over, and hang up ourselves.
constexpr std::chrono::seconds kLook{1};
constexpr std::string_view kMediaType = "application/json";

bool names(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    if (equal_ignoring_case(next_element(list, ','), word)) return true;
  }
  return false;
}

class WebSocketConnection final : public Connection {
 public:
  WebSocketConnection(ServerCore& core, WebSocketOpening opening)
      : Connection(std::move(opening.peer_address)),
        core_(core),
        stream_(std::move(opening.socket)),
        received_(std::move(opening.received)),
        entry_(opening.entry) {}

  void open();
  void wake() override;
  void expire() override;
  void stop() override;
  void close() override;

 private:
  enum class State { Opening, Open, Closing, Closed };

  void listen();
  void look_again() { deadline_ = core_.now + kLook; }
  void push();
  void on_pushed(net::error_code failed, std::size_t size);
  void pushed();
  [[nodiscard]] std::shared_ptr<WebSocketConnection> self() {
    return std::static_pointer_cast<WebSocketConnection>(shared_from_this());
  }

  ServerCore& core_;
  websocket::stream<net::Socket> stream_;
  std::string received_;
  const Router::Entry* entry_;
  State state_ = State::Opening;
  boost::beast::flat_buffer said_{kMaxSaid};
  DocumentPtr shown_;  ///< Last version sent, or being sent.
  bool writing_ = false;
  bool pending_ = false;
};

void WebSocketConnection::open() {
  const auto& limits = core_.config.limits;
  set_up(stream_, limits, kMaxSaid);
  net::keep_queue_small(stream_.next_layer());
  deadline_ = core_.now + limits.header_timeout;
  stream_.async_accept(asio::buffer(received_), [me = self()](net::error_code failed) {
    if (me->state_ != State::Opening) return;
    if (failed) return me->close();
    me->state_ = State::Open;
    me->received_ = {};
    me->look_again();
    count(me->core_.counters.websockets_open);
    me->core_.wait_for(me->entry_->index, me);
    me->listen();
    me->push();
  });
}

void WebSocketConnection::listen() {
  stream_.async_read(said_, [me = self()](net::error_code failed, std::size_t) {
    if (failed) return me->close();
    me->said_.consume(me->said_.size());
    me->listen();
  });
}

void WebSocketConnection::expire() {
  if (state_ != State::Open || writing_ || !stream_.is_open()) return close();
  look_again();
}

void WebSocketConnection::wake() {
  if (state_ != State::Open) return;
  core_.wait_for(entry_->index, shared_from_this());
  push();
}

void WebSocketConnection::push() {
  if (writing_) {
    if (pending_) count(core_.counters.events_skipped);
    pending_ = true;
    return;
  }
  pending_ = false;
  DocumentPtr next = entry_->live->current();
  if (next == nullptr || next == shown_) return;
  const auto chosen = next->choose(kMediaType);
  if (!chosen)
    return;  // There is no such form and never will be: the socket stays open and silent.
  shown_ = std::move(next);
  writing_ = true;
  deadline_ = core_.now + core_.config.limits.write_timeout;
  const std::string_view body = (*chosen)->body();
  stream_.async_write(
      asio::buffer(body.data(), body.size()),
      [me = self()](net::error_code failed, std::size_t size) { me->on_pushed(failed, size); });
}

void WebSocketConnection::on_pushed(net::error_code failed, std::size_t size) {
  if (state_ != State::Open) {
    writing_ = false;
    return;
  }
  if (failed) return close();
  count(core_.counters.bytes_sent, size);
  if (net::is_queue_small(stream_.next_layer())) return pushed();
  stream_.next_layer().async_wait(net::Socket::wait_write, [me = self()](net::error_code broken) {
    if (me->state_ != State::Open) return;
    broken ? me->close() : me->pushed();
  });
}

void WebSocketConnection::pushed() {
  writing_ = false;
  look_again();
  if (pending_) push();
}

void WebSocketConnection::stop() {
  if (state_ != State::Open || writing_) return close();
  state_ = State::Closing;
  uncount(core_.counters.websockets_open);
  core_.stop_waiting(entry_->index, this);
  stream_.async_close(websocket::close_code::going_away,
                      [me = self()](net::error_code) { me->close(); });
}

void WebSocketConnection::close() {
  if (state_ == State::Closed) return;
  const State before = std::exchange(state_, State::Closed);
  const auto keep = shared_from_this();  // forget() drops what may be the last reference.
  if (before == State::Open) uncount(core_.counters.websockets_open);
  core_.stop_waiting(entry_->index, this);
  net::error_code ignored;
  stream_.next_layer().close(ignored);
  core_.forget(this);
}

}  // namespace

bool asks_for_websocket(const RequestHead& head) {
  return head.method == Method::Get && names(head.upgrade, "websocket") &&
         names(head.connection, "upgrade");
}

bool may_open(const RequestHead& head, std::string_view allowed_origin) {
  return !is_present(head.origin) || from_own_page(head) || allowed_origin == "*" ||
         head.origin == allowed_origin;
}

Subprotocols subprotocols_of(const RequestHead& head, std::string_view protocol) {
  constexpr std::string_view kToken = "chorus.token.";
  Subprotocols found;
  for (const Field& field : head.fields) {
    if (!equal_ignoring_case(field.name, "Sec-WebSocket-Protocol")) continue;
    for (std::string_view list = field.value; !list.empty();) {
      const std::string_view one = next_element(list, ',');
      if (one == protocol) found.named = true;
      if (!one.starts_with(kToken)) continue;
      const auto decoded = decode_query("token=" + std::string(one.substr(kToken.size())));
      if (decoded) found.token = decoded->at("token");
    }
  }
  return found;
}

std::shared_ptr<Connection> open_websocket(ServerCore& core, WebSocketOpening opening) {
  if (opening.dialogue) return talk_by_websocket(core, std::move(opening));
  auto connection = std::make_shared<WebSocketConnection>(core, std::move(opening));
  connection->open();
  return connection;
}

}  // namespace chorus::http
