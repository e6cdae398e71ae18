// The square.
#pragma once

namespace chorus {

[[nodiscard]] constexpr double square(double value) noexcept { return value * value; }

}  // namespace chorus
