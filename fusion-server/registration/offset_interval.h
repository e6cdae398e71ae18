// The offsets that the walk does not exclude with 95 % confidence.
#pragma once

#include <vector>

#include "fusion-server/registration/offset_profile.h"

namespace chorus::registration {

inline constexpr double kSigmas95 = 1.96;

struct OffsetInterval {
  double middle = 0.0;  ///< The most likely offset [s].
  double low = 0.0;
  double high = 0.0;
};

/// `fits`: at least one, equally spaced.  Near the best, offsets with a significant likelihood
/// ratio are excluded; farther away, where there may be another mode, only those that fit worse in
/// more frames than chance allows (Vuong 1989).
[[nodiscard]] OffsetInterval interval_of(const std::vector<OffsetFit>& fits);

}  // namespace chorus::registration
