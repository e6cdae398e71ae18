// The cubic from 0 to 1 that is level at both ends.
#pragma once

namespace chorus::synthetic {

/// `x` in [0, 1].
[[nodiscard]] constexpr double smoothstep(double x) { return x * x * (3 - 2 * x); }

}  // namespace chorus::synthetic
