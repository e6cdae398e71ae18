#include <deque>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/http/server_core.h"
#include "common/http/websocket.h"
#include "common/http/websocket_stream.h"
#include "common/net/small_queue.h"

namespace chorus::http {
namespace {

constexpr std::chrono::milliseconds kLook{250};
// How long the client may take for its own close frame.
constexpr std::chrono::seconds kGoodbye{2};
// Of a message that is too long, up to this many times the permitted length is still read.  If the
// connection were closed with bytes unread, the client would lose what it was told last.
constexpr int kMaxReadOn = 8;

class DialogueConnection final : public Connection {
 public:
  DialogueConnection(ServerCore& core, WebSocketOpening opening)
      : Connection(std::move(opening.peer_address)),
        core_(core),
        stream_(std::move(opening.stream),
                {core.config.limits, opening.entry->dialogue->max_message_bytes,
                 std::move(opening.protocol)}),
        dialogue_(std::move(opening.dialogue)),
        entry_(*opening.entry),
        most_(opening.entry->dialogue->max_message_bytes) {}

  void open(std::string received);
  void wake() override;
  void expire() override;
  void stop() override { say_goodbye(Goodbye::GoingAway); }
  void close() override;

 private:
  enum class State { Opening, Open, Closing, Closed };

  void listen();
  void on_heard(net::error_code failed);
  void end(const Error& why, Goodbye code);
  template <class Speaking>
  void react(const Speaking& speaking);
  void keep(std::vector<std::string>& messages, bool binary);
  void send_next();
  void on_sent();
  void say_goodbye(Goodbye code);
  [[nodiscard]] std::shared_ptr<DialogueConnection> self() {
    return std::static_pointer_cast<DialogueConnection>(shared_from_this());
  }

  ServerCore& core_;
  WebSocketStream stream_;
  std::shared_ptr<Dialogue> dialogue_;
  const Router::Entry& entry_;
  std::size_t most_;  ///< Bytes of a message.
  State state_ = State::Opening;
  struct Unsent {
    std::string bytes;
    bool binary = false;
  };
  std::deque<Unsent> unsent_;  ///< The first is being sent.
  bool woken_ = false;         ///< Woken while something was being sent.
  std::size_t unsent_bytes_ = 0;
  bool over_ = false;  ///< The dialogue ends when everything in unsent_ has been sent,
  Goodbye ending_ = Goodbye::Policy;  ///< for this reason.
  int read_on_ = 0;
  SteadyTime sending_until_{};
};

void DialogueConnection::open(std::string received) {
  stream_.on_flood([this] { close(); });
  deadline_ = core_.now + core_.config.limits.header_timeout;
  stream_.accept(std::move(received), [me = self()](net::error_code failed) {
    if (me->state_ != State::Opening) return;
    if (failed) return me->close();
    me->state_ = State::Open;
    me->deadline_ = me->core_.now + kLook;
    count(me->core_.counters.websockets_open);
    if (me->entry_.dialogue->wake) {
      net::keep_queue_small(me->stream_.socket());
      me->core_.wait_for(me->entry_.index, me);
    }
    me->listen();
  });
}

void DialogueConnection::listen() {
  stream_.read([me = self()](net::error_code failed) { me->on_heard(failed); });
}

void DialogueConnection::on_heard(net::error_code failed) {
  if (state_ == State::Closed) return;
  const bool too_long = failed == asio::error::message_size;
  if ((failed && !too_long) || (too_long && ++read_on_ > kMaxReadOn)) return close();
  if (state_ == State::Open && !over_) {
    if (too_long) {
      end({ErrorCode::TooLarge, {}, fmt::format("a message has at most {} bytes", most_)},
          Goodbye::TooBig);
    } else if (stream_.is_text()) {
      react([&] { return dialogue_->hear(stream_.message()); });
    } else {
      end({ErrorCode::Unsupported, {}, "binary messages are not taken; send text"},
          Goodbye::UnknownData);
    }
  }
  if (state_ != State::Closed) listen();
}

void DialogueConnection::end(const Error& why, Goodbye code) {
  ending_ = code;
  over_ = true;
  react([&] { return dialogue_->end(why); });
}

/// Calls the dialogue; an exception from it ends this dialogue only.
template <class Speaking>
void DialogueConnection::react(const Speaking& speaking) {
  Reply reply;
  try {
    reply = speaking();
  } catch (const std::exception& thrown) {
    log::error("a dialogue failed", {{"reason", thrown.what()}});
    return say_goodbye(Goodbye::Internal);
  }
  over_ = over_ || reply.over;
  const bool idle = unsent_.empty();
  keep(reply.messages, false);
  keep(reply.binary, true);
  if (unsent_bytes_ > entry_.dialogue->max_unread) return close();
  if (idle) send_next();
}

void DialogueConnection::keep(std::vector<std::string>& messages, bool binary) {
  for (std::string& message : messages) {
    unsent_bytes_ += message.size();
    unsent_.push_back({std::move(message), binary});
  }
}

/// What is new is asked for only when the client has taken all before it: it may miss something,
/// but what it gets is new.
void DialogueConnection::wake() {
  if (state_ != State::Open) return;
  core_.wait_for(entry_.index, shared_from_this());
  woken_ = !unsent_.empty();
  if (!woken_ && !over_) react([this] { return dialogue_->look(); });
}

void DialogueConnection::send_next() {
  if (unsent_.empty()) {
    if (over_) return say_goodbye(ending_);
    if (std::exchange(woken_, false)) react([this] { return dialogue_->look(); });
    return;
  }
  sending_until_ = core_.now + core_.config.limits.write_timeout;
  const Unsent& next = unsent_.front();
  stream_.write(
      next.bytes,
      [me = self()](net::error_code failed) {
        if (me->state_ != State::Open) return;
        failed ? me->close() : me->on_sent();
      },
      next.binary);
}

/// With wake(), the kernel's queue must be small, too, before something new is asked for.
void DialogueConnection::on_sent() {
  const auto go_on = [me = self()](net::error_code broken) {
    if (me->state_ != State::Open) return;
    if (broken) return me->close();
    count(me->core_.counters.bytes_sent, me->unsent_.front().bytes.size());
    me->unsent_bytes_ -= me->unsent_.front().bytes.size();
    me->unsent_.pop_front();
    me->send_next();
  };
  if (!entry_.dialogue->wake || net::is_queue_small(stream_.socket())) return go_on({});
  stream_.socket().async_wait(net::Socket::wait_write, go_on);
}

void DialogueConnection::expire() {
  const bool stuck = !unsent_.empty() && core_.now > sending_until_;
  if (state_ != State::Open || stuck || !stream_.is_open()) return close();
  deadline_ = core_.now + kLook;
  const bool busy = entry_.dialogue->wake && !unsent_.empty();
  if (!over_ && !busy) react([this] { return dialogue_->look(); });
}

/// Ends the dialogue with a close frame, and cuts the client off if it does not answer in time.  If
/// no such frame can be sent now, closes the connection at once.
void DialogueConnection::say_goodbye(Goodbye code) {
  if (state_ != State::Open || !unsent_.empty() || !stream_.say_goodbye(code)) return close();
  state_ = State::Closing;
  uncount(core_.counters.websockets_open);
  core_.stop_waiting(entry_.index, this);
  dialogue_.reset();
  deadline_ = core_.now + kGoodbye;
}

void DialogueConnection::close() {
  if (state_ == State::Closed) return;
  const State before = std::exchange(state_, State::Closed);
  const auto keep = shared_from_this();  // forget() may drop the last reference.
  if (before == State::Open) uncount(core_.counters.websockets_open);
  core_.stop_waiting(entry_.index, this);
  dialogue_.reset();
  stream_.close();
  core_.forget(this);
}

}  // namespace

void talk_by_websocket(ServerCore& core, WebSocketOpening opening, const Connection* asker) {
  std::string received = std::move(opening.received);
  auto connection = std::make_shared<DialogueConnection>(core, std::move(opening));
  core.replace(asker, connection);
  connection->open(std::move(received));
}

}  // namespace chorus::http
