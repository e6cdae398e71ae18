// Finds from the motion how far the sensors' clocks differ.
//
// Every pair of sensors whose clocks are not known measures their offset (offset_profile.h); what
// each clock states about itself is the prior.  Weighted least squares over the network of all
// pairs gives one offset per sensor.  A pair is refused if its place varies too much over the
// offsets that the network does not exclude.  Derived in docs/papers/registration.md, Section 10.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

/// What the walk says about the clocks.
struct WalkClocks {
  /// One for every sensor that sent frames, relative to the clock that is known best.  Empty if all
  /// clocks are known.
  std::map<SensorId, ClockOffset> offsets;
  /// Target and source of the pairs whose place depends on an offset that the walk does not
  /// determine, with the reason.
  std::map<std::pair<SensorId, SensorId>, Error> open;
};

/// `stopped` is called between pairs; once it returns true, the rest is not measured and the result
/// must not be used.
[[nodiscard]] WalkClocks clocks_of(const std::vector<WalkTrack>& walk,
                                   const RegistrationConfig& config,
                                   const std::function<bool()>& stopped = {});

/// Moves every stamp to the common clock.
void bring_in_step(std::vector<WalkTrack>& walk, const WalkClocks& clocks);

/// The same estimator, but it refuses pairs whose clock offset is undetermined.
[[nodiscard]] PairEstimator unless_open(PairEstimator estimate, const WalkClocks& clocks);

}  // namespace chorus::registration
