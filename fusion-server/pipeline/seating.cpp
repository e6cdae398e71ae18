#include "fusion-server/pipeline/seating.h"

#include <algorithm>
#include <utility>

namespace chorus::pipeline {

void Seating::seat(std::vector<FusedBody>& bodies, Timestamp instant, Duration keep,
                   const SeatingConfig& config) {
  release_absent(bodies, instant, keep);
  seat_those_who_stood_in();
  move_up(config.front);
  for (FusedBody& body : bodies) body.slot = slot_of(body.id, instant);
}

void Seating::leave(PersonId person) {
  for (auto& seat : seats_) {
    if (seat && seat->person == person) seat.reset();
  }
}

void Seating::release_absent(const std::vector<FusedBody>& here, Timestamp instant, Duration keep) {
  for (auto& seat : seats_) {
    if (!seat) continue;
    seat->absent = std::ranges::find(here, seat->person, &FusedBody::id) == here.end();
    if (seat->absent && std::chrono::abs(instant - seat->seen) > keep) seat.reset();
  }
}

void Seating::seat_those_who_stood_in() {
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    if (!seats_[i] || seats_[i]->absent) continue;
    if (const auto free = free_of_those(seats_[i]->stands_in_for)) move(i, *free);
  }
}

/// The lowest of these slots that nobody has any more.  Those whose person came back, or that
/// somebody else got, are awaited no longer.
std::optional<std::size_t> Seating::free_of_those(std::bitset<kMaxBodies>& awaited) const {
  for (std::size_t slot = 0; awaited.any() && slot < seats_.size(); ++slot) {
    if (!awaited[slot]) continue;
    if (!seats_[slot]) return slot;
    awaited[slot] = seats_[slot]->absent;
  }
  return std::nullopt;
}

void Seating::move_up(std::size_t front) {
  std::size_t free = 0;
  for (std::size_t i = front; i < seats_.size(); ++i) {
    if (!seats_[i] || seats_[i]->absent) continue;
    while (free < front && seats_[free]) ++free;
    if (free == front) return;
    move(i, free);
  }
}

/// Moves a person to a lower slot.  From then on, only slots below that one are awaited.
void Seating::move(std::size_t from, std::size_t to) {
  seats_[to] = std::exchange(seats_[from], std::nullopt);
  auto& awaited = seats_[to]->stands_in_for;
  for (std::size_t slot = to; slot < awaited.size(); ++slot) awaited.reset(slot);
}

std::bitset<kMaxBodies> Seating::absent_below(std::size_t slot) const {
  std::bitset<kMaxBodies> absent;
  for (std::size_t lower = 0; lower < slot; ++lower) {
    absent[lower] = seats_[lower] && seats_[lower]->absent;
  }
  return absent;
}

std::optional<std::size_t> Seating::slot_of(PersonId person, Timestamp instant) {
  const auto found = std::find_if(seats_.begin(), seats_.end(),
                                  [&](const auto& seat) { return seat && seat->person == person; });
  if (found != seats_.end()) {
    (*found)->seen = instant;
    return static_cast<std::size_t>(found - seats_.begin());
  }
  const auto empty = std::find(seats_.begin(), seats_.end(), std::nullopt);
  const auto slot = static_cast<std::size_t>(empty - seats_.begin());
  if (slot == kMaxBodies) return std::nullopt;
  if (empty == seats_.end()) seats_.emplace_back();
  seats_[slot] = Seat{person, instant, false, absent_below(slot)};
  return slot;
}

}  // namespace chorus::pipeline
