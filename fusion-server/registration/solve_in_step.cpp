// Brings the sensors of a walk in step, and solves it (registration.h).
#include "fusion-server/registration/guessed_depth.h"
#include "fusion-server/registration/latency.h"
#include "fusion-server/registration/overruled_clocks.h"
#include "fusion-server/registration/pair_registration.h"
#include "fusion-server/registration/ray_depths.h"
#include "fusion-server/registration/ray_places.h"
#include "fusion-server/registration/registration.h"
#include "fusion-server/registration/time_offset.h"

namespace chorus::registration {
namespace {

Registration solve_as_stated(const std::vector<WalkTrack>& walk, Timestamp now,
                             const RegistrationConfig& config) {
  const WalkClocks clocks = clocks_of(walk, config);
  const PairEstimator estimate =
      unless_open([&](const Walker& target,
                      const Walker& source) { return register_walkers(target, source, config); },
                  clocks);
  std::vector<WalkTrack> in_step = walk;
  bring_in_step(in_step, clocks);
  Registration found = without_latencies(
      in_step, [&] { return solve_with(estimate, in_step, now, config); }, config);
  found.clocks = offsets_of_placed(clocks, found);
  return settled(std::move(found), in_step, config);
}

}  // namespace

Registration solve(const std::vector<WalkTrack>& seen, Timestamp now,
                   const RegistrationConfig& wanted) {
  const std::vector<WalkTrack> walk = with_ray_depths(seen, wanted);
  const RegistrationConfig config = suited_to(walk, wanted);
  const auto solved = [&](const std::vector<WalkTrack>& tracks) {
    return solve_as_stated(tracks, now, config);
  };
  return overruling_clocks(solved(walk), walk, solved);
}

}  // namespace chorus::registration
