// Solving a walk on the worker: pairs on all cores, given up as soon as nobody wants the result.
#pragma once

#include "fusion-server/core/registrar.h"

namespace chorus::server {

/// The same registration as registration::solve finds.  What the solver throws over strange clouds
/// becomes a refusal with the reason.
[[nodiscard]] core::Solution solve(const core::SolveJob& job, Timestamp now);

}  // namespace chorus::server
