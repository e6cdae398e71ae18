// Who is, or lately was, in view of the tracker, and what they are called.
//
// A plain value without clock, thread or socket: snapshots go in, /people/ and events come out.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/duration.h"
#include "common/base/result.h"
#include "common/base/strong_id.h"
#include "common/body/stature.h"
#include "common/time/timestamp.h"
#include "fusion-server/flow/snapshot.h"

namespace chorus::journal {

enum class Presence {
  Seen,      ///< A sensor sees the person.
  Expected,  ///< No sensor does; the person is where they are expected.
  Left,      ///< Not in the frame; a person who comes back in time is recognised.
};

[[nodiscard]] std::string_view name_of(Presence presence);

struct KnownPerson {
  PersonId id;
  std::string name = {};  ///< Empty: nobody gave one.
  Presence presence = Presence::Seen;
  std::optional<std::size_t> slot = {};
  Timestamp since = {};                     ///< First instant with this person.
  std::optional<Timestamp> last_seen = {};  ///< Set unless the person is seen.
  /// Rounded to 1 %, stature to 1 cm: what is shown changes only when it means something.
  std::optional<double> sides_confidence = {};
  std::optional<LearnedLength> stature = {};
  std::vector<SensorId> sensors = {};  ///< That see the person now.
  /// The last time that the person was published under another id.
  std::optional<Correction> correction = {};
};

class Roll {
 public:
  /// `remember`: for how long a person who left is listed (AssociationConfig::remember).
  explicit Roll(Duration remember) : remember_(remember) {}
  void remember_for(Duration remember) { remember_ = remember; }

  /// Returns true if people() is different now.  A snapshot from before the last one is ignored,
  /// unless the clock was set back by more than `remember`: then the roll begins anew.
  bool take(const Snapshot& snapshot);

  /// Ordered by id.
  [[nodiscard]] const std::vector<KnownPerson>& people() const { return people_; }
  [[nodiscard]] const KnownPerson* find(PersonId id) const;

  /// Gives a person a name; empty takes it away.  A name of somebody who left moves to this person.
  /// NotFound for a person who is not listed, Conflict if somebody else in view has the name,
  /// InvalidArgument as checked_name().
  Result<void> rename(PersonId id, std::string_view name);
  /// Strikes a person off, with the name.  Later snapshots do not bring this id back: the tracker
  /// forgets it, too, and gives the person a new id.  NotFound as rename().
  Result<void> forget(PersonId id);

 private:
  KnownPerson& entry_of(PersonId id, Timestamp instant);

  Duration remember_;
  Timestamp instant_{};
  std::vector<KnownPerson> people_;
  std::set<PersonId> forgotten_;
};

}  // namespace chorus::journal
