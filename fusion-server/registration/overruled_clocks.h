// When sensors contradict one another although their clocks claim to be in step, the clocks may be
// wrong: the walk is solved again as if no clock were known, before anybody is refused.
#pragma once

#include <functional>
#include <vector>

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

using SolveWalk = std::function<Registration(const std::vector<WalkTrack>&)>;

/// `found`, or, if sensors of it contradict others and some clock claims to be known, what `solve`
/// finds without these claims, if that places more sensors; a reason says so.  The offsets hold for
/// frames of unknown clocks (ClockOffset::stated): whoever goes on with the frames of this walk has
/// to drop their claims, too (claims_overruled()).
[[nodiscard]] Registration overruling_clocks(Registration found, const std::vector<WalkTrack>& walk,
                                             const SolveWalk& solve);

/// Whether the offsets were found without the claims of clocks.
[[nodiscard]] bool claims_overruled(const Registration& found);

}  // namespace chorus::registration
