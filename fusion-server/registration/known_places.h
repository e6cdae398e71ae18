// What the adjustment knows besides the walk: floors, where the world stands, which sensors must
// not move, and how much too near the sensors report joints.
//
// Everything is added to the equations of (omega, tau of every sensor; depth bias); sensor i has
// the rows from 6 i on, the depth bias has the last one.  docs/papers/registration.md, Section 8.
#pragma once

#include <string>
#include <vector>

#include "fusion-server/flow/registration.h"
#include "fusion-server/registration/walk_points.h"

namespace chorus::registration {

/// By how much all sensors report joints too near, along their lines of sight [m].
struct DepthBias {
  double expected = 0.0;
  double sigma = 0.0;    ///< Of what is expected; positive.
  double present = 0.0;  ///< The present estimate.

  [[nodiscard]] double beyond() const { return present - expected; }
};

/// As configured, with the present estimate as expected.
[[nodiscard]] DepthBias depth_bias_of(const RegistrationConfig& config);

/// What to do about a depth bias that the walk shows and nobody has configured.
[[nodiscard]] std::string advice_on(const WalkedDepthBias& found);

/// The robust loss (Geman-McClure) of the sensor's own floor; 0 without one.
[[nodiscard]] double floor_loss(const Station& station);

/// Adds each sensor's own floor.
void add_floors(PlaceEquations& equations, const std::vector<Station>& stations);

/// Holds the master's position on the floor, and its yaw; with `level_held` all of its place.
void hold_gauge(PlaceEquations& equations, const std::vector<Station>& stations);

/// Sensors with too few points must not move: their rows become the identity.
void hold_fixed(PlaceEquations& equations, const std::vector<Station>& stations);

/// Adds what is expected of the depth bias.
void add_depth_bias(PlaceEquations& equations, const DepthBias& bias);

}  // namespace chorus::registration
