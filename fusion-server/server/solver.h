// Solves a walk on the worker: pairs on all cores, stopped once nobody needs the result.
#pragma once

#include "fusion-server/core/registrar.h"

namespace chorus::server {

/// Gives the same registration as registration::solve.  Exceptions over degenerate point clouds
/// become a refusal with the reason.
[[nodiscard]] core::Solution solve(const core::SolveJob& job, Timestamp now);

}  // namespace chorus::server
