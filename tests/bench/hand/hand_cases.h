// The cases of `chorus-bench hand`.
#pragma once

#include "tests/bench/report/report.h"

namespace chorus::bench {

/// Drawn hands with a truth: fingers, side, tips, lengths; and drawn things that must be refused.
[[nodiscard]] Result<void> synthetic_hands(Report& report);
[[nodiscard]] Result<void> things_refused(Report& report);

/// Pictures of people's hands (CHORUS_HANDS), against tips that a person has looked at.
[[nodiscard]] Result<void> hand_photos(Report& report);
[[nodiscard]] Result<void> hand_silhouettes(Report& report);

/// Several pictures of one hand: do the shares of the fingers agree?
[[nodiscard]] Result<void> repeated_drawings(Report& report);
[[nodiscard]] Result<void> repeated_silhouettes(Report& report);

[[nodiscard]] Result<void> scan_speed(Report& report);

/// Rendered gloves whose pose is told (Madaras et al., 3.6 and 5.4).
[[nodiscard]] Result<void> glove_places(Report& report);

}  // namespace chorus::bench
