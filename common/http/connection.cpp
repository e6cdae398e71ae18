#include "common/http/connection.h"

#include <array>
#include <cstring>

#include "common/http/problem.h"
#include "common/http/server_core.h"
#include "common/http/websocket.h"

namespace chorus::http {
namespace {

constexpr std::chrono::seconds kLingerTime{2};
constexpr std::size_t kLingerBytes = 1u << 20;  // What a refused client may still send.

constexpr int kBadRequest = 400;
constexpr int kRequestTimeout = 408;
constexpr int kUriTooLong = 414;
constexpr int kFieldsTooLarge = 431;
constexpr int kNotModified = 304;
constexpr int kUnauthorized = 401;
constexpr int kTooManyRequests = 429;
constexpr int kUnavailable = 503;

}  // namespace

Connection::Connection(ServerCore& core, Socket socket, const tcp::endpoint& remote)
    : Session(account_of(remote.address())),
      core_(core),
      socket_(std::move(socket)),
      buffer_(std::make_unique_for_overwrite<char[]>(core.config.limits.max_header_bytes)),
      capacity_(core.config.limits.max_header_bytes) {
  error_code failed;
  const auto local = socket_.local_endpoint(failed);
  peer_.loopback = unmapped(remote.address()).is_loopback();
  peer_.proxy = core_.is_proxy(remote.address());
  peer_.local_address = unmapped(local.address()).to_string();
  peer_.local_port = local.port();
  peer_.account = peer_address();
  socket_.set_option(tcp::no_delay(true), failed);
}

void Connection::expire_in(std::chrono::seconds time) { deadline_ = core_.now + time; }

void Connection::start() {
  expire_in(core_.config.limits.idle_timeout);
  read();
}

void Connection::start_in_reserve() {
  in_reserve_ = close_after_ = true;
  expire_in(core_.config.limits.header_timeout);
  read();
}

bool Connection::idle() const { return state_ == State::Head && begin_ == end_ && !in_reserve_; }

void Connection::read() {
  if (reading_ || end_ == capacity_) return;
  reading_ = true;
  socket_.async_read_some(
      net::buffer(buffer_.get() + end_, capacity_ - end_),
      [self = self()](error_code failed, std::size_t size) { self->on_read(failed, size); });
}

void Connection::on_read(error_code failed, std::size_t size) {
  reading_ = false;
  if (state_ == State::Closed) return;
  if (failed) {
    end_of_input_ = true;
    // What has been asked before the end of input is still answered, but nobody waits any longer.
    if (failed != net::error::eof || state_ != State::Writing) close();
    return;
  }
  end_ += size;
  switch (state_) {
    case State::Head:
      received_ = core_.config.clock->now();
      if (end_ - begin_ == size) expire_in(core_.config.limits.header_timeout);
      return advance();
    case State::Body:
      return advance_body();
    case State::Lingering:
      drained_ += size;
      end_ = begin_ = 0;
      return drained_ > kLingerBytes ? close() : read();
    default:
      return;  // A request ahead of its time; it stays in the buffer.
  }
}

void Connection::advance() {
  const auto head_end = find_head_end(unread(), checked_);
  if (head_end.progress == HeadProgress::Broken)
    return refuse(kBadRequest, "lines end in CR LF and a request begins with its request line");
  if (head_end.progress == HeadProgress::Complete) return serve(head_end.size);
  checked_ = unread().size();
  make_room();
  if (end_ == capacity_) {
    const bool line_done = unread().find('\n') != std::string_view::npos;
    return refuse(line_done ? kFieldsTooLarge : kUriTooLong,
                  "a request line with its header fields has at most " + std::to_string(capacity_) +
                      " bytes");
  }
  read();
}

void Connection::make_room() {
  if (reading_ || begin_ == 0) return;
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
}

void Connection::refuse(int status, std::string detail) {
  count(core_.counters.refused);
  send(core_.responder.refuse({status, std::move(detail)}));
}

void Connection::serve(std::size_t head_size) {
  request_size_ = head_size;
  if (auto refusal = read_head(unread().substr(0, head_size), head_))
    return refuse(refusal->status, std::move(refusal->detail));
  count(core_.counters.requests);
  if (!head_.keep_alive) close_after_ = true;
  if (!may_ask()) return refuse_for_now("too many connections; keep fewer open");
  reaction_ = core_.responder.react(head_, peer_);
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
      return upgrade();
  }
}

/// Whether there is room for this request's sender; beyond the limits only for what is vital.
bool Connection::may_ask() {
  if (peer_.proxy) {
    const auto account = forwarded_account(head_);
    if (account && !core_.charge(*this, *account)) return core_.responder.is_vital(head_);
    peer_.account = peer_address();
  }
  return !in_reserve_ || core_.responder.is_vital(head_);
}

void Connection::refuse_for_now(std::string detail) { refuse(kUnavailable, std::move(detail)); }

/// The socket and what has been read of it go to a session that speaks the other protocol.
void Connection::upgrade() {
  WebSocketOpening opening{std::move(socket_), std::string(unread()), peer_address(),
                           reaction_.entry};
  reaction_.entry = nullptr;
  state_ = State::Closed;
  core_.replace(this, open_websocket(core_, std::move(opening)));
}

void Connection::begin_body() {
  state_ = State::Body;
  body_.clear();
  expire_in(core_.config.limits.body_timeout);
  if (!head_.expects_continue) return advance_body();
  // The client holds the body back until it reads this; nothing else is being written now.
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  net::async_write(socket_, net::buffer(kContinue),
                   [self = self()](error_code failed, std::size_t) {
                     if (failed) return self->close();
                     if (self->state_ == State::Body) self->advance_body();
                   });
}

void Connection::advance_body() {
  // The head stays where it is, for the action to read; the body is taken out behind it.
  const std::size_t from = begin_ + request_size_;
  const auto wanted = static_cast<std::size_t>(head_.content_length) - body_.size();
  const std::size_t part = std::min(wanted, end_ - from);
  body_.append(buffer_.get() + from, part);
  std::memmove(buffer_.get() + from, buffer_.get() + from + part, end_ - from - part);
  end_ -= part;
  if (part < wanted) {
    // A head that fills the buffer leaves no room to read its body through.
    if (end_ == capacity_)
      return refuse(kFieldsTooLarge, "shorten the header fields of a request with a body");
    return read();
  }
  send(core_.responder.act(reaction_, head_, peer_, body_));
}

void Connection::send(Answer answer) {
  if (answer.file && !begin_download()) {
    count(core_.counters.refused);
    answer = core_.responder.refuse(
        {kUnavailable, "too many files are on their way to others; ask again when one is done"});
  }
  answer_ = std::move(answer);
  sent_of_file_ = 0;
  state_ = State::Writing;
  close_after_ = close_after_ || answer_.close || core_.stopping;
  expire_in(core_.config.limits.write_timeout);
  if (answer_.status == kNotModified) count(core_.counters.not_modified);
  if (answer_.status == kUnauthorized || answer_.status == kTooManyRequests)
    count(core_.counters.unauthorized);
  first_lines_.clear();
  const bool tell = head_.minor_version == 0 && !close_after_;
  write_first_lines(first_lines_, answer_,
                    {received_, core_.config.clock->now(), close_after_, tell});
  const std::array<net::const_buffer, 4> buffers{
      net::buffer(first_lines_), net::buffer(answer_.route), net::buffer(answer_.own),
      net::buffer(answer_.body)};
  net::async_write(socket_, buffers, [self = self()](error_code failed, std::size_t size) {
    self->on_sent(failed, size);
  });
}

void Connection::on_sent(error_code failed, std::size_t size) {
  if (state_ == State::Closed) return;
  count(core_.counters.bytes_sent, size);
  if (!failed && send_piece()) return;
  answer_ = {};
  end_download();
  if (failed) return close();
  if (reaction_.kind == Reaction::Kind::Stream) {
    state_ = State::Streaming;
    return push_event();
  }
  if (close_after_ || core_.stopping) return linger();
  next_request();
}

bool Connection::begin_download() {
  auto& open = core_.counters.downloads_open;
  if (open.load(std::memory_order_relaxed) >= core_.config.limits.max_downloads) return false;
  count(open);
  return downloading_ = true;
}

void Connection::end_download() {
  if (std::exchange(downloading_, false))
    count(core_.counters.downloads_open, static_cast<std::uint64_t>(-1));
}

/// The next piece of the answer's file; false when there is none left.
bool Connection::send_piece() {
  if (!answer_.file || sent_of_file_ >= answer_.file->size()) return false;
  if (!answer_.file->read(sent_of_file_, piece_)) {
    close();  // the length is announced: only a broken connection tells that it was not kept
    return true;
  }
  sent_of_file_ += piece_.size();
  expire_in(core_.config.limits.write_timeout);
  net::async_write(
      socket_, net::buffer(piece_),
      [self = self()](error_code failed, std::size_t size) { self->on_sent(failed, size); });
  return true;
}

void Connection::next_request() {
  begin_ += request_size_;
  request_size_ = checked_ = 0;
  state_ = State::Head;
  if (begin_ == end_) {
    if (!reading_) begin_ = end_ = 0;
    expire_in(core_.config.limits.idle_timeout);
    return end_of_input_ ? close() : read();
  }
  received_ = core_.config.clock->now();
  expire_in(core_.config.limits.header_timeout);
  advance();
}

/// Tells the client that no more comes and reads on until it has understood: closing with unread
/// input would reset the connection and destroy the answer on its way.
void Connection::linger() {
  state_ = State::Lingering;
  begin_ = end_ = 0;
  error_code failed;
  socket_.shutdown(tcp::socket::shutdown_send, failed);
  if (failed || end_of_input_) return close();
  expire_in(kLingerTime);
  read();
}

void Connection::begin_wait() {
  if (core_.counters.long_polls_waiting.load(std::memory_order_relaxed) >=
      core_.config.limits.max_long_polls)
    return refuse_for_now("too many long polls are waiting; ask without Prefer: wait");
  state_ = State::Waiting;
  expire_in(reaction_.wait);
  count(core_.counters.long_polls_waiting);
  wait_on();
  if (state_ == State::Waiting) watch();
}

/// Waits for the next version, unless it has come since the last look: a publish wakes only those
/// who wait.
void Connection::wait_on() {
  core_.wait_for(reaction_.entry->index, shared_from_this());
  auto answer = core_.responder.waited(*reaction_.entry, head_);
  if (!answer) return;
  core_.stop_waiting(reaction_.entry->index, this);
  end_wait(std::move(*answer));
}

void Connection::end_wait(Answer answer) {
  count(core_.counters.long_polls_waiting, static_cast<std::uint64_t>(-1));
  send(std::move(answer));
}

/// Reads on while there is nothing to answer, to notice a client that leaves.  Not when more
/// requests are in the buffer already: then the buffer has to be free to move.
void Connection::watch() {
  if (unread().size() == request_size_) read();
}

void Connection::wake() {
  if (state_ == State::Closed) return;
  if (state_ == State::Waiting) {
    auto answer = core_.responder.waited(*reaction_.entry, head_);
    return answer ? end_wait(std::move(*answer)) : wait_on();
  }
  core_.wait_for(reaction_.entry->index, shared_from_this());
  if (state_ == State::Streaming) push_event();
}

void Connection::expire() {
  switch (state_) {
    case State::Head:
      if (unread().empty()) return close();
      [[fallthrough]];
    case State::Body:
      return refuse(kRequestTimeout, "the request did not arrive in time; send it at once");
    case State::Waiting:
      core_.stop_waiting(reaction_.entry->index, this);
      count(core_.counters.long_polls_waiting, static_cast<std::uint64_t>(-1));
      return send(core_.responder.given_up(*reaction_.entry, head_));
    case State::Streaming:
      return push_event();
    default:
      return close();
  }
}

void Connection::stop() {
  switch (state_) {
    case State::Waiting:
      core_.stop_waiting(reaction_.entry->index, this);
      count(core_.counters.long_polls_waiting, static_cast<std::uint64_t>(-1));
      return send(core_.responder.refuse({kUnavailable, "the service is stopping"}));
    case State::Writing:
    case State::Body:
      return;
    default:
      return close();
  }
}

void Connection::close() {
  if (state_ == State::Closed) return;
  const State before = std::exchange(state_, State::Closed);
  const auto self = shared_from_this();  // forget() drops what may be the last reference.
  end_download();
  if (before == State::Waiting)
    count(core_.counters.long_polls_waiting, static_cast<std::uint64_t>(-1));
  if (reaction_.kind == Reaction::Kind::Stream)
    count(core_.counters.event_streams_open, static_cast<std::uint64_t>(-1));
  if (reaction_.entry != nullptr) core_.stop_waiting(reaction_.entry->index, this);
  error_code ignored;
  socket_.close(ignored);
  core_.forget(this);
}

}  // namespace chorus::http
