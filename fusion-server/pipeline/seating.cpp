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

void Seating::release_absent(const std::vector<FusedBody>& here, Timestamp instant, Duration keep) {
  for (auto& seat : seats_) {
    if (!seat) continue;
    seat->absent = std::ranges::find(here, seat->person, &FusedBody::id) == here.end();
    if (seat->absent && std::chrono::abs(instant - seat->seen) > keep) seat.reset();
  }
}

void Seating::seat_those_who_stood_in() {
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    if (!seats_[i] || seats_[i]->waits_for == i) continue;
    auto& awaited = seats_[seats_[i]->waits_for];
    if (awaited && awaited->absent) continue;
    const bool came_back = awaited.has_value();
    if (came_back) {
      seats_[i]->waits_for = i;
    } else {
      awaited = std::exchange(seats_[i], std::nullopt);
    }
  }
}

void Seating::move_up(std::size_t front) {
  std::size_t free = 0;
  for (std::size_t i = front; i < seats_.size(); ++i) {
    if (!seats_[i] || seats_[i]->absent) continue;
    while (free < front && seats_[free]) ++free;
    if (free == front) return;
    seats_[i]->waits_for = std::min(seats_[i]->waits_for, free);
    seats_[free] = std::exchange(seats_[i], std::nullopt);
  }
}

std::size_t Seating::slot_to_wait_for(std::size_t free) const {
  for (std::size_t lower = 0; lower < free; ++lower) {
    if (!seats_[lower] || !seats_[lower]->absent) continue;
    const auto waiting = std::count_if(seats_.begin(), seats_.end(), [&](const auto& seat) {
      return seat && seat->waits_for == lower;
    });
    const bool its_own = seats_[lower]->waits_for == lower;
    if (waiting == (its_own ? 1 : 0)) return lower;
  }
  return free;
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
  seats_[slot] = Seat{person, instant, false, slot_to_wait_for(slot)};
  return slot;
}

}  // namespace chorus::pipeline
