// Sensors that see people where no other sensor does.
//
// Association no longer takes what they see for the people that the others see, so that watch/,
// which compares views of one person, has nothing to compare.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fusion-server/flow/person.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/snapshot.h"
#include "fusion-server/flow/standing.h"

namespace chorus::core {

/// What the pipeline knows at one instant.
struct Sights {
  Timestamp instant;
  const std::vector<SensorReport>& reports;  ///< Of the sensors that have a place.
  const std::vector<Person>& people;         ///< The published ones.
  const std::vector<Standing>& standings;    ///< What the sensors say of everybody.
  const Registration& registration;
};

class Strays {
 public:
  void look(const Sights& sights);

  /// Since when the sensor has seen somebody, but none of the people whom others see.  None before
  /// it has done so for ten seconds.  One view of a person whom others see, too, ends it; time in
  /// which this sensor or all others see nobody does not count.  While this sensor alone sees a
  /// published person, there may be two people.  Then only those instants count in which each side
  /// misses a person of the other side (Standing::missed_by).
  [[nodiscard]] std::optional<Timestamp> since(const SensorId& sensor) const;

  void forget() { apart_.clear(); }
  /// Forgets sensors that are no longer configured.
  void keep(const std::set<SensorId>& sensors);

 private:
  struct Apart {
    Timestamp since;
    Duration seen{0};
  };

  std::map<SensorId, Apart> apart_;
  std::optional<Timestamp> last_;
};

/// "s4 has seen somebody where no other sensor does, for 12 s; ...".
[[nodiscard]] std::string stray_sentence(const SensorId& sensor, Timestamp since, Timestamp now);

}  // namespace chorus::core
