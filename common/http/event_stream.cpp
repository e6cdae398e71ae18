// Server-sent events (WHATWG HTML 9.2): the newest document, as often as the reader can take it.
#include "common/http/connection.h"
#include "common/http/server_core.h"
#include "common/http/small_queue.h"

namespace chorus::http {
namespace {

constexpr std::chrono::seconds kHeartbeat{15};

std::shared_ptr<const std::string> heartbeat(Coding coding) {
  constexpr std::string_view kComment = ":\n\n";
  static const auto plain = std::make_shared<const std::string>(kComment);
  static const auto coded = std::make_shared<const std::string>(gzip_piece(kComment));
  return coding == Coding::Gzip ? coded : plain;
}

}  // namespace

void Connection::begin_stream() {
  count(core_.counters.event_streams_open);
  keep_queue_small(socket_);
  core_.wait_for(reaction_.entry->index, shared_from_this());
  const auto current = reaction_.entry->live->current();
  // A reader that comes back and has the newest already gets the next one.
  if (current && !head_.last_event_id.empty() && head_.last_event_id == current->options().version)
    streamed_ = current;
  watch();
  send(std::move(reaction_.answer));
}

void Connection::push_event() {
  if (event_under_way_) {
    // Still writing the last one at the next publish: only the newest waits, the others are
    // skipped.
    if (core_.now >= deadline_) return close();
    if (event_pending_) count(core_.counters.events_skipped);
    event_pending_ = true;
    return;
  }
  const Coding coding = coding_for(head_.accept_encoding);
  const DocumentPtr newest = reaction_.entry->live->current();
  event_ = newest && newest != streamed_ ? newest->event(reaction_.event_type, coding) : nullptr;
  if (newest) streamed_ = newest;
  if (!event_ && core_.now < deadline_) return;
  if (!event_) event_ = heartbeat(coding);
  event_under_way_ = true;
  expire_in(core_.config.limits.write_timeout);
  net::async_write(
      socket_, net::buffer(*event_),
      [self = self()](error_code failed, std::size_t size) { self->on_event_sent(failed, size); });
}

void Connection::on_event_sent(error_code failed, std::size_t size) {
  if (state_ == State::Closed) return;
  count(core_.counters.bytes_sent, size);
  event_.reset();
  if (failed) return close();
  if (is_queue_small(socket_)) return event_done();
  socket_.async_wait(Socket::wait_write, [self = self()](error_code broken) {
    if (self->state_ == State::Closed) return;
    broken ? self->close() : self->event_done();
  });
}

void Connection::event_done() {
  event_under_way_ = false;
  expire_in(kHeartbeat);
  if (std::exchange(event_pending_, false)) push_event();
}

}  // namespace chorus::http
