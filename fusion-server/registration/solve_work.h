// What solve_with() keeps between its steps, and its last step: the verdict.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

/// Why two sensors have no edge.
struct Refusal {
  SensorId target;
  SensorId source;
  Error error;
};

/// All intermediate results between the walk and the verdict.
struct Work {
  const std::vector<WalkTrack>& walk;
  const RegistrationConfig& config;
  const Stopped& stopped;
  std::map<SensorId, Walker> walkers;
  std::map<SensorId, const WalkTrack*> tracks;
  std::vector<Refusal> refusals;
  std::set<SensorId> outcasts;  ///< They contradict the others; the reason is noted.
  Registration result;
  bool doubtful = false;  ///< True if there is a doubt that concerns all places.
  bool floor_guessed = false;

  void doubt(std::string reason) {
    doubtful = true;
    tell(std::move(reason));
  }
  /// Adds a doubt about the place of one sensor, or why it has none; the others stay good.
  void doubt(const SensorId& sensor, std::string reason) {
    result.verdicts[sensor].reasons.push_back(reason);
    tell(std::move(reason));
  }
  /// Adds a reason that leaves the verdict as it is.
  void tell(std::string reason) {
    if (std::ranges::find(result.reasons, reason) == result.reasons.end())
      result.reasons.push_back(std::move(reason));
  }
};

/// Refuses sensors whose place is too uncertain.
void refuse_wide(Work& work);

/// Sets the verdicts, and says why sensors have no place or are not placed well.
void judge(Work& work);

}  // namespace chorus::registration
