// Whom sensors see where others, which look there too, see nobody: who disagrees with whom.
//
// Nobody knows which of them errs: it may be a mirror, a coat, a sensor that was moved, or a shelf
// before the others.  So this only tells.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/time/timestamp.h"
#include "fusion-server/flow/standing.h"

namespace chorus::core {

class Contests {
 public:
  void look(Timestamp instant, const std::vector<Standing>& standings);

  /// "s2, s3 see somebody at (1.2, -0.4) m, where s1, s4, s5 look and see nobody", if the sensor is
  /// one of those who see them; empty if nobody contradicts it, or only since half a second ago.
  [[nodiscard]] std::string sentence_of(const SensorId& sensor) const;

  /// How many such bodies the sensor has seen since the start, each once however long it lasted.
  [[nodiscard]] std::uint64_t count_of(const SensorId& sensor) const;

  /// Forgets whom nobody believes, but not how many they were.
  void forget() { contests_.clear(); }

 private:
  struct Contest {
    Timestamp since, last;  ///< The first and the last instant of it.
    Standing standing;      ///< At the last one.
    bool counted = false;
  };
  [[nodiscard]] static bool lasts(const Contest& contest);

  std::map<PersonId, Contest> contests_;
  std::map<SensorId, std::uint64_t> counts_;
};

}  // namespace chorus::core
