#include "fusion-server/registration/overruled_clocks.h"

#include <algorithm>

#include <fmt/format.h>

#include "fusion-server/flow/clock_offset.h"
#include "fusion-server/registration/consensus.h"

namespace chorus::registration {
namespace {

bool anybody_contradicts(const Registration& found) {
  return std::ranges::any_of(found.reasons, [](const std::string& reason) {
    return reason.find(kContradicts) != std::string::npos;
  });
}

bool claims_time(const WalkTrack& track) {
  return !track.frames.empty() && exchanges_time(track.frames.front().clock_sigma);
}

/// The walk as if no clock were known.
std::vector<WalkTrack> without_claims(std::vector<WalkTrack> walk) {
  for (WalkTrack& track : walk) {
    for (SensorFrame& frame : track.frames) frame.clock_sigma = kUnknownClock;
  }
  return walk;
}

Duration widest(const Registration& found) {
  Duration most{0};
  for (const auto& [sensor, clock] : found.clocks)
    most = std::max(most, std::chrono::abs(clock.added));
  return most;
}

}  // namespace

Registration overruling_clocks(Registration found, const std::vector<WalkTrack>& walk,
                               const SolveWalk& solve) {
  const bool doubtful = anybody_contradicts(found) || found.verdict == Verdict::Refused;
  if (!doubtful || std::ranges::none_of(walk, claims_time)) return found;
  Registration again = solve(without_claims(walk));
  if (again.sensors.size() <= found.sensors.size()) return found;
  again.reasons.push_back(
      fmt::format("the clocks are not in step as stated, but up to {:.0f} ms apart, as the walk "
                  "shows",
                  1e3 * seconds(widest(again))));
  return again;
}

bool claims_overruled(const Registration& found) {
  return !found.clocks.empty() && std::ranges::none_of(found.clocks, [](const auto& each) {
    return exchanges_time(seconds(each.second.stated));
  });
}

}  // namespace chorus::registration
