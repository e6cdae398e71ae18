// Solves a walk on the worker: pairs on all cores, stopped as soon as nobody wants the result.
#pragma once

#include "fusion-server/core/registrar.h"

namespace chorus::server {

/// Finds the same registration as registration::solve.  Exceptions over strange point clouds become
/// a refusal with the reason.
[[nodiscard]] core::Solution solve(const core::SolveJob& job, Timestamp now);

}  // namespace chorus::server
