#include "common/http/websocket.h"

#include <utility>

#include "common/http/server_core.h"
#include "common/http/websocket_stream.h"
#include "common/net/small_queue.h"

namespace chorus::http {
namespace {

constexpr std::size_t kMaxSaid = 4096;  ///< Limit of one message from a client.
/// When a WebSocket has been closed or is broken, Beast waits for the client to hang up.  At this
/// interval we check whether the WebSocket is still open, and hang up ourselves if it is not.
constexpr std::chrono::milliseconds kOverCheck{250};

class WebSocketConnection final : public Connection {
 public:
  WebSocketConnection(ServerCore& core, WebSocketOpening opening)
      : Connection(std::move(opening.peer_address)),
        core_(core),
        stream_(std::move(opening.stream), {core.config.limits, kMaxSaid}),
        entry_(opening.entry),
        reader_(*opening.entry, std::move(opening.wish)) {}

  void open(std::string received);
  void wake() override;
  void expire() override;
  void stop() override;
  void close() override;

 private:
  enum class State { Opening, Open, Closing, Closed };

  void listen();
  void look_again() { deadline_ = core_.now + kOverCheck; }
  void push();
  void on_pushed(net::error_code failed);
  void pushed();
  [[nodiscard]] std::shared_ptr<WebSocketConnection> self() {
    return std::static_pointer_cast<WebSocketConnection>(shared_from_this());
  }

  ServerCore& core_;
  WebSocketStream stream_;
  const Router::Entry* entry_;
  State state_ = State::Opening;
  LiveReader reader_;
  std::shared_ptr<const std::string_view> message_;  ///< Being sent.
  bool writing_ = false;
  std::size_t sent_ = 0;  ///< Size of the message with `shown_` [bytes].
  bool pending_ = false;
};

void WebSocketConnection::open(std::string received) {
  net::keep_queue_small(stream_.socket());
  stream_.on_flood([this] { close(); });
  deadline_ = core_.now + core_.config.limits.header_timeout;
  stream_.accept(std::move(received), [me = self()](net::error_code failed) {
    if (me->state_ != State::Opening) return;
    if (failed) return me->close();
    me->state_ = State::Open;
    me->look_again();
    count(me->core_.counters.websockets_open);
    me->core_.wait_for(me->entry_->index, me);
    me->listen();
    me->push();
  });
}

void WebSocketConnection::listen() {
  stream_.read([me = self()](net::error_code failed) {
    if (failed == asio::error::message_size && me->state_ == State::Open)
      (void)me->stream_.say_goodbye(Goodbye::TooBig);
    failed ? me->close() : me->listen();
  });
}

void WebSocketConnection::expire() {
  if (state_ != State::Open || writing_ || !stream_.is_open()) return close();
  look_again();
  if (reader_.held_until()) push();  // what the rate held back, if nothing newer has come
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
  message_ = reader_.message(core_.now, core_.woken_for(entry_->index));
  if (!message_) return;
  writing_ = true;
  deadline_ = core_.now + core_.config.limits.write_timeout;
  sent_ = message_->size();
  stream_.write(*message_, [me = self()](net::error_code failed) { me->on_pushed(failed); });
}

void WebSocketConnection::on_pushed(net::error_code failed) {
  if (state_ != State::Open) {
    writing_ = false;
    return;
  }
  if (failed) return close();
  count(core_.counters.bytes_sent, sent_);
  if (net::is_queue_small(stream_.socket())) return pushed();
  stream_.socket().async_wait(net::Socket::wait_write, [me = self()](net::error_code broken) {
    if (me->state_ != State::Open) return;
    broken ? me->close() : me->pushed();
  });
}

void WebSocketConnection::pushed() {
  writing_ = false;
  look_again();
  if (pending_ || reader_.has_more()) push();
}

void WebSocketConnection::stop() {
  if (state_ != State::Open || !stream_.say_goodbye(Goodbye::GoingAway)) return close();
  state_ = State::Closing;  // until the client leaves, which ends the read
  uncount(core_.counters.websockets_open);
  core_.stop_waiting(entry_->index, this);
}

void WebSocketConnection::close() {
  if (state_ == State::Closed) return;
  const State before = std::exchange(state_, State::Closed);
  const auto keep = shared_from_this();  // forget() may drop the last reference.
  if (before == State::Open) uncount(core_.counters.websockets_open);
  core_.stop_waiting(entry_->index, this);
  stream_.close();
  core_.forget(this);
}

}  // namespace

void open_websocket(ServerCore& core, WebSocketOpening opening, const Connection* asker) {
  if (opening.dialogue) return talk_by_websocket(core, std::move(opening), asker);
  std::string received = std::move(opening.received);
  auto connection = std::make_shared<WebSocketConnection>(core, std::move(opening));
  core.replace(asker, connection);  // first, because it may end before open() returns
  connection->open(std::move(received));
}

}  // namespace chorus::http
