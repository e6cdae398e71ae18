// A suit that another Chorus service serves: a chorus-sensor with the device `suit`, `inertial` or
// `bridge`, or a tracker.
#pragma once

#include "services/sensor/device/suit/suit_source.h"

namespace chorus::suit {

/// The pose in a body of a frame: its joints with the floor's normal as +y.  Without a floor, the
/// sensor's own +y counts as up.  The place that the service says is `claimed`.
[[nodiscard]] SuitInstant instant_of(const SensorFrame& frame, const BodyFrame& body);

/// Follows `settings.service`; of several bodies the one at position `settings.character`, by id.
[[nodiscard]] std::unique_ptr<SuitSource> serve_suit(const SuitSettings& settings,
                                                     std::shared_ptr<const Clock> clock);

}  // namespace chorus::suit
