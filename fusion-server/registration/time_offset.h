// Finds from the motion how far the sensors' clocks differ.
//
// Every pair of sensors whose clocks are not known measures their offset (offset_profile.h); what
// each clock states about itself is the prior.  Weighted least squares over the network of all
// pairs gives one offset per sensor.  A pair is refused if its place varies too much over the
// offsets that the network does not exclude.  Derived in docs/papers/registration.md, Section 10.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

/// What the walk shows about the clocks.
struct WalkClocks {
  /// One for every sensor that sent frames, relative to the clock that is known best. Empty if all
  /// clocks are known, and for PairMethod::IcpOnly, which does not use time.
  std::map<SensorId, ClockOffset> offsets;
  /// Target and source of the pairs whose place depends on an offset that the walk does not
  /// determine, with the reason.
  std::map<std::pair<SensorId, SensorId>, Error> open;
};

/// How the pairs are searched: they do not depend on one another.
struct PairSearch {
  /// Asked before each pair; once it returns true, the other pairs are not searched, and the result
  /// is of no use.
  std::function<bool()> stopped = [] { return false; };
  /// Calls work(i) for each i below `count`, in any order and on any thread.
  std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)> for_each =
      [](std::size_t count, const std::function<void(std::size_t)>& work) {
        for (std::size_t i = 0; i < count; ++i) work(i);
      };
};

[[nodiscard]] WalkClocks clocks_of(const std::vector<WalkTrack>& walk,
                                   const RegistrationConfig& config, const PairSearch& search = {});

/// Moves every stamp to the common clock.
void bring_in_step(std::vector<WalkTrack>& walk, const WalkClocks& clocks);

/// `estimate`, changed to refuse pairs whose clock offset is undetermined.
[[nodiscard]] PairEstimator unless_open(PairEstimator estimate, const WalkClocks& clocks);

/// The offsets of the sensors that have a place.  A walk in which a sensor contradicts the others,
/// because it followed somebody else, says nothing of its clock.
[[nodiscard]] std::map<SensorId, ClockOffset> offsets_of_placed(const WalkClocks& clocks,
                                                                const Registration& found);

}  // namespace chorus::registration
