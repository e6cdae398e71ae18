// Who has which number: persons are seated in slots, instant after instant.
//
// A value without clock, thread or socket: the instants tell how long somebody has been away.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "fusion-server/flow.h"

namespace chorus::outlet {

/// How long an absent person's slot stays free for it: as long as association looks out for it
/// (associate::AssociationConfig::coast).
inline constexpr Duration kKeepSlot = std::chrono::seconds(1);

/// The slot of an absent person is nobody's until it has been away for longer than it is kept.  Who
/// came meanwhile stands in a higher slot and then moves to that one: fusion may have given the
/// same person a new id, and a protocol with one slot would show nobody any more.
class Seating {
 public:
  explicit Seating(std::size_t slots) : seats_(slots) {}

  [[nodiscard]] std::size_t size() const { return seats_.size(); }
  void keep_slots_for(Duration absence) { keep_slot_ = absence; }

  /// To be called once an instant, before slot_of().
  void begin(const std::set<PersonId>& here, Timestamp instant);
  /// None: all slots are taken (the oldest stay).
  [[nodiscard]] std::optional<std::size_t> slot_of(PersonId person, Timestamp instant);

 private:
  void release_absent(const std::set<PersonId>& here, Timestamp instant);
  void seat_those_who_stood_in();
  [[nodiscard]] std::size_t slot_to_wait_for(std::size_t free) const;

  struct Seat {
    PersonId person;
    Timestamp seen;
    bool absent = false;
    /// Its own slot, or a lower one whose person was absent when this one came.
    std::size_t waits_for = 0;
  };

  std::vector<std::optional<Seat>> seats_;  ///< By slot.
  Duration keep_slot_ = kKeepSlot;
};

}  // namespace chorus::outlet
