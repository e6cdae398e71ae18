// The shapes of drawn hands and feet, before they lie on a sheet.
#pragma once

#include <array>
#include <vector>

#include "common/hand/hand.h"
#include "tests/support/hands/hand_scene.h"

namespace chorus::testing {

/// In millimetres of a right hand on its palm's side: x towards the thumb, y towards the fingers,
/// from the wrist.
struct Figure {
  std::array<hand::Pixel, hand::kHandJoints> joints{};
  std::array<std::vector<hand::Pixel>, 5> outlines;
  std::vector<hand::Pixel> palm;
  std::vector<hand::Pixel> forearm;
};

[[nodiscard]] Figure figure_of(const HandScene& scene);

/// Five toes on a sole.
[[nodiscard]] Figure foot_of(const HandScene& scene);

}  // namespace chorus::testing
