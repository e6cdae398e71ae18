// The scan that comes with the repository (tests/data/hand): an A4 sheet at 100 dpi with a drawn
// right hand, its palm seen, and what is true of it.
#pragma once

#include <string>

#include "tests/support/hands/hand_scene.h"

namespace chorus::testing {

[[nodiscard]] HandScene shipped_scene();

/// {"side", "seen", "mmPerPixel", "fingers": {"thumb": {"fromWebMm", "tip"}, ...}}: tests compare
/// it with what a scan says.
[[nodiscard]] std::string truth_json(const DrawnHand& drawn);

}  // namespace chorus::testing
