// Waiting for the next version: long polls, and server-sent events (WHATWG HTML 9.2), which send
// the newest document as often as the reader can take it.
#include <algorithm>
#include <utility>

#include "common/http/conversation.h"
#include "common/http/status.h"

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

void Conversation::begin_wait() {
  if (context_.counters.long_polls_waiting.load(std::memory_order_relaxed) >=
      context_.config.limits.max_long_polls)
    return refuse(status::kUnavailable,
                  "too many long polls are waiting; ask without Prefer: wait");
  state_ = State::Waiting;
  expire_in(reaction_.wait);
  count(context_.counters.long_polls_waiting);
  orders_.wait = true;
}

void Conversation::on_woken() {
  if (state_ == State::Waiting) {
    auto answer = context_.responder.waited(*reaction_.entry, head_);
    if (answer) return end_wait(std::move(*answer));
  }
  orders_.wait = state_ == State::Waiting || reaction_.kind == Reaction::Kind::Stream;
}

/// A publish wakes only registered waits, so this looks for a version published just before.
void Conversation::on_look(DocumentPtr newest) {
  if (state_ == State::Streaming) return push_event(std::move(newest));
  if (state_ != State::Waiting) return;
  auto answer = context_.responder.waited(*reaction_.entry, head_);
  if (!answer) return watch();
  orders_.stop_waiting = true;
  end_wait(std::move(*answer));
}

void Conversation::end_wait(Answer answer) {
  uncount(context_.counters.long_polls_waiting);
  send(std::move(answer));
}

/// Keeps reading while there is nothing to answer, to notice when the client leaves; but not if the
/// buffer contains more requests, because compact() must then be possible.
void Conversation::watch() {
  if (unread().size() == request_size_) read();
}

void Conversation::begin_stream() {
  count(context_.counters.event_streams_open);
  orders_.small_queue = orders_.wait = true;
  reader_.emplace(*reaction_.entry, std::move(reaction_.wish));
  watch();
  send(std::move(reaction_.answer));
}

void Conversation::push_event(DocumentPtr newest) {
  if (event_under_way_) {
    // If the last event is still being written when new versions are published, only the newest
    // version waits; those in between are skipped.
    if (now_ >= deadline_) return hang_up();
    if (event_pending_) count(context_.counters.events_skipped);
    event_pending_ = true;
    return;
  }
  const Coding coding = coding_for(head_.accept_encoding);
  const bool due = now_ >= deadline_;
  event_ = reader_->event(reaction_.event_type, coding, now_, std::move(newest));
  if (const auto held = reader_->held_until()) deadline_ = std::min(deadline_, *held);
  if (!event_ && !due) return;
  if (!event_) event_ = heartbeat(coding);
  event_under_way_ = true;
  write(*event_);
  // Not where more follows: each would be sent out of the sending of the one before.
  orders_.at_once = !reader_->has_more();
}

void Conversation::on_settled() {
  event_under_way_ = false;
  expire_in(kHeartbeat);
  if (std::exchange(event_pending_, false) || reader_->has_more()) push_event();
}

}  // namespace chorus::http
