// Assigns people to numbered slots, once for all outputs.
//
// A plain value without clock, thread or socket: the instants determine how long a person was
// absent.
#pragma once

#include <bitset>
#include <optional>
#include <vector>

#include "common/time/timestamp.h"
#include "fusion-server/flow/fused_body.h"

namespace chorus::pipeline {

struct SeatingConfig {
  /// Number of slots that every output shows.  A person in a higher slot moves when one of these
  /// becomes free.
  std::size_t front = 6;

  bool operator==(const SeatingConfig&) const = default;
};

/// An absent person's slot stays reserved while the person may return.  Meanwhile a newcomer gets a
/// higher slot, and moves to the lowest of the reserved ones to which nobody returns: the newcomer
/// may be the same person with a new id, several times over, and a protocol with one slot would
/// otherwise show nobody any more.  When the clock is set back by more than the time for which
/// slots are reserved, seating begins anew, as association does.
class Seating {
 public:
  /// Sets FusedBody::slot of each body; bodies beyond kMaxBodies get none.  `keep`: how long an
  /// absent person's slot stays reserved (associate::AssociationConfig::coast).
  void seat(std::vector<FusedBody>& bodies, Timestamp instant, Duration keep,
            const SeatingConfig& config = {});

  /// Frees the slot of a person who does not come back under this id.
  void leave(PersonId person);

 private:
  struct Seat {
    PersonId person;
    Timestamp seen;
    bool absent = false;
    /// Lower slots whose persons were absent when this one arrived, and have not come back.
    std::bitset<kMaxBodies> stands_in_for;
  };

  void release_absent(const std::vector<FusedBody>& here, Timestamp instant, Duration keep);
  void seat_those_who_stood_in();
  [[nodiscard]] std::optional<std::size_t> free_of_those(std::bitset<kMaxBodies>& awaited) const;
  void move_up(std::size_t front);
  void move(std::size_t from, std::size_t to);
  [[nodiscard]] std::bitset<kMaxBodies> absent_below(std::size_t slot) const;
  [[nodiscard]] std::optional<std::size_t> slot_of(PersonId person, Timestamp instant);

  std::vector<std::optional<Seat>> seats_;  ///< By slot; at most kMaxBodies.
};

}  // namespace chorus::pipeline
