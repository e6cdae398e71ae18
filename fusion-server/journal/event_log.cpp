#include "fusion-server/journal/event_log.h"

#include <algorithm>
#include <utility>

namespace chorus::journal {
namespace {

constexpr Duration kMinute = std::chrono::minutes(1);

}  // namespace

bool EventLog::add(Event event) {
  // Of people and recordings there are ever new ones: what is over is not counted further.
  std::erase_if(rates_, [&](const auto& one) { return event.time - one.second.minute > kMinute; });
  Rate& rate = rates_.try_emplace(event.kind + " " + event.about, Rate{event.time}).first->second;
  if (++rate.count > limits_.a_minute) return false;
  if (rate.count == limits_.a_minute)
    event.message += " (This happens again and again: more of it is left out for a minute.)";
  event.id = next_++;
  age(event.time);
  events_.push_back(std::move(event));
  if (events_.size() > limits_.most) events_.pop_front();
  return true;
}

void EventLog::age(Timestamp now) {
  while (!events_.empty() && now - events_.front().time > limits_.kept) events_.pop_front();
}

std::optional<Event> EventLog::after(std::uint64_t id) const {
  const auto next = std::ranges::upper_bound(events_, id, {}, &Event::id);
  if (next == events_.end()) return std::nullopt;
  return *next;
}

}  // namespace chorus::journal
