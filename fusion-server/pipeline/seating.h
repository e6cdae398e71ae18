// Who has which number: persons are seated in slots, instant after instant, once for all outputs.
//
// A value without clock, thread or socket: the instants tell how long somebody has been away.
#pragma once

#include <optional>
#include <vector>

#include "fusion-server/flow.h"

namespace chorus::pipeline {

struct SeatingConfig {
  /// Slots that every output shows.  Who sits further back moves up when one of them is free.
  std::size_t front = 6;

  bool operator==(const SeatingConfig&) const = default;
};

/// The slot of an absent person is nobody's until it has been away for longer than it is kept.  Who
/// came meanwhile stands in a higher slot and then moves to that one: fusion may have given the
/// same person a new id, and a protocol with one slot would show nobody any more.  A clock that is
/// set back by more than a slot is kept begins anew, as association does.
class Seating {
 public:
  /// Sets FusedBody::slot of each; bodies beyond kMaxBodies get none.  `keep`: how long the slot of
  /// an absent person stays its own (associate::AssociationConfig::coast).
  void seat(std::vector<FusedBody>& bodies, Timestamp instant, Duration keep,
            const SeatingConfig& config = {});

 private:
  struct Seat {
    PersonId person;
    Timestamp seen;
    bool absent = false;
    /// Its own slot, or a lower one whose person was absent when this one came.
    std::size_t waits_for = 0;
  };

  void release_absent(const std::vector<FusedBody>& here, Timestamp instant, Duration keep);
  void seat_those_who_stood_in();
  void move_up(std::size_t front);
  [[nodiscard]] std::size_t slot_to_wait_for(std::size_t free) const;
  [[nodiscard]] std::optional<std::size_t> slot_of(PersonId person, Timestamp instant);

  std::vector<std::optional<Seat>> seats_;  ///< By slot; at most kMaxBodies.
};

}  // namespace chorus::pipeline
