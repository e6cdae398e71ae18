#include <deque>
#include <utility>

#include "common/base/log.h"
#include "common/http/beast_websocket.h"
#include "common/http/server_core.h"
#include "common/http/websocket.h"

namespace chorus::http {
namespace {

namespace websocket = boost::beast::websocket;

constexpr std::chrono::milliseconds kLook{250};
constexpr std::chrono::seconds kGoodbye{2};  // how long the client's own close may take

class DialogueConnection final : public Connection {
 public:
  DialogueConnection(ServerCore& core, WebSocketOpening opening)
      : Connection(std::move(opening.peer_address)),
        core_(core),
        stream_(std::move(opening.socket)),
        received_(std::move(opening.received)),
        protocol_(std::move(opening.protocol)),
        dialogue_(std::move(opening.dialogue)),
        heard_(opening.entry->dialogue->max_message_bytes) {}

  void open();
  void wake() override {}
  void expire() override;
  void stop() override { say_goodbye(websocket::close_code::going_away); }
  void close() override;

 private:
  enum class State { Opening, Open, Closing, Closed };

  void set_options();
  void listen();
  void on_heard(net::error_code failed);
  template <class Speaking>
  void react(const Speaking& speaking);
  void send_next();
  void say_goodbye(websocket::close_code code);
  [[nodiscard]] std::shared_ptr<DialogueConnection> self() {
    return std::static_pointer_cast<DialogueConnection>(shared_from_this());
  }

  ServerCore& core_;
  websocket::stream<net::Socket> stream_;
  std::string received_;
  std::string protocol_;
  std::shared_ptr<Dialogue> dialogue_;
  State state_ = State::Opening;
  boost::beast::flat_buffer heard_;
  std::deque<std::string> unsent_;  ///< The first is being sent.
  std::size_t unsent_bytes_ = 0;
  bool over_ = false;  ///< Ends when everything unsent has been sent.
  SteadyTime sending_until_{};
};

void DialogueConnection::set_options() {
  set_up(stream_, core_.config.limits, heard_.max_size());
  if (protocol_.empty()) return;
  stream_.set_option(
      websocket::stream_base::decorator([protocol = protocol_](websocket::response_type& response) {
        response.set("Sec-WebSocket-Protocol", protocol);
      }));
}

void DialogueConnection::open() {
  set_options();
  deadline_ = core_.now + core_.config.limits.header_timeout;
  stream_.async_accept(asio::buffer(received_), [me = self()](net::error_code failed) {
    if (me->state_ != State::Opening) return;
    if (failed) return me->close();
    me->state_ = State::Open;
    me->received_ = {};
    me->deadline_ = me->core_.now + kLook;
    count(me->core_.counters.websockets_open);
    me->listen();
  });
}

void DialogueConnection::listen() {
  stream_.async_read(heard_,
                     [me = self()](net::error_code failed, std::size_t) { me->on_heard(failed); });
}

void DialogueConnection::on_heard(net::error_code failed) {
  if (state_ == State::Closed) return;
  if (failed) return close();
  if (state_ == State::Open && !stream_.got_text())
    return say_goodbye(websocket::close_code::unknown_data);
  if (state_ == State::Open && !over_) {
    const auto bytes = heard_.cdata();
    const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
    react([&] { return dialogue_->hear(text); });
  }
  heard_.consume(heard_.size());
  if (state_ != State::Closed) listen();
}

/// What the dialogue throws ends this dialogue only.
template <class Speaking>
void DialogueConnection::react(const Speaking& speaking) {
  Reply reply;
  try {
    reply = speaking();
  } catch (const std::exception& thrown) {
    log::error("a dialogue failed", {{"reason", thrown.what()}});
    return say_goodbye(websocket::close_code::internal_error);
  }
  over_ = over_ || reply.over;
  const bool idle = unsent_.empty();
  for (std::string& message : reply.messages) {
    unsent_bytes_ += message.size();
    unsent_.push_back(std::move(message));
  }
  if (unsent_bytes_ > kMaxUnread) return close();
  if (idle) send_next();
}

void DialogueConnection::send_next() {
  if (unsent_.empty()) {
    if (over_) say_goodbye(websocket::close_code::policy_error);
    return;
  }
  sending_until_ = core_.now + core_.config.limits.write_timeout;
  stream_.async_write(asio::buffer(unsent_.front()),
                      [me = self()](net::error_code failed, std::size_t n) {
                        if (me->state_ != State::Open) return;
                        if (failed) return me->close();
                        count(me->core_.counters.bytes_sent, n);
                        me->unsent_bytes_ -= me->unsent_.front().size();
                        me->unsent_.pop_front();
                        me->send_next();
                      });
}

void DialogueConnection::expire() {
  const bool stuck = !unsent_.empty() && core_.now > sending_until_;
  if (state_ != State::Open || stuck || !stream_.is_open()) return close();
  deadline_ = core_.now + kLook;
  if (!over_) react([this] { return dialogue_->look(); });
}

/// Ends it politely, once; a client that does not reply is cut off.
void DialogueConnection::say_goodbye(websocket::close_code code) {
  if (state_ != State::Open || !unsent_.empty()) return close();
  state_ = State::Closing;
  count(core_.counters.websockets_open, static_cast<std::uint64_t>(-1));
  dialogue_.reset();
  deadline_ = core_.now + kGoodbye;
  stream_.async_close(code, [me = self()](net::error_code) { me->close(); });
}

void DialogueConnection::close() {
  if (state_ == State::Closed) return;
  const State before = std::exchange(state_, State::Closed);
  const auto keep = shared_from_this();  // forget() drops what may be the last reference.
  if (before == State::Open) count(core_.counters.websockets_open, static_cast<std::uint64_t>(-1));
  dialogue_.reset();
  net::error_code ignored;
  stream_.next_layer().close(ignored);
  core_.forget(this);
}

}  // namespace

std::shared_ptr<Connection> talk_by_websocket(ServerCore& core, WebSocketOpening opening) {
  auto connection = std::make_shared<DialogueConnection>(core, std::move(opening));
  connection->open();
  return connection;
}

}  // namespace chorus::http
