// How long a registration session may be asked to last.
#pragma once

namespace chorus::wire {

/// Limits of a session's length [s]: shorter walks cannot be solved, longer ones waste memory.
inline constexpr double kMinSession = 8.0;
inline constexpr double kMaxSession = 300.0;

}  // namespace chorus::wire
