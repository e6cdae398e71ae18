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

#include "fusion-server/flow.h"

namespace chorus::core {

class Strays {
 public:
  /// Takes the reports of the sensors that have a place, and the people of the same instant.
  void look(const std::vector<SensorReport>& reports, const std::vector<Person>& people,
            Timestamp instant);

  /// Since when the sensor has seen somebody, but none of the people whom others see.  None before
  /// it has done so for ten seconds, not counting those in which it saw nobody, or the others did
  /// not; one view that is shared, or that makes a person of its own, ends it.
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
