// Whether a body that a sensor shows can be the person who wears these inertial sensors.
//
// A limb that points elsewhere than its sensor says speaks against it; one that fits says little,
// because people stand and walk alike.  So this is never evidence for somebody, only against.
#pragma once

#include <optional>
#include <span>

#include "fusion-server/associate/placed_view.h"

namespace chorus::associate {

/// From 0, as the limbs of the one who wears them fit, to 1, as limbs that have nothing to do with
/// what the sensors say; none where the view shows no limb with a sensor.  Left and right may be
/// exchanged in the view.
[[nodiscard]] std::optional<double> unlike_worn(const SensorView& view,
                                                std::span<const WornLimb> worn);

/// The same in the mean of all views that show such a limb; none if no view does.
[[nodiscard]] std::optional<double> unlike_worn(std::span<const PlacedView> views,
                                                std::span<const WornLimb> worn);

}  // namespace chorus::associate
