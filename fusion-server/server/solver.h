// Solves a walk on the worker: solves pairs on all cores, and stops when nobody needs the result
// any more.
#pragma once

#include "fusion-server/core/solve_job.h"

namespace chorus::server {

/// Gives the same registration as registration::solve(), unless the job is stopped. An exception
/// becomes a refusal with the reason.
[[nodiscard]] core::Solution solve(const core::SolveJob& job, Timestamp now);

}  // namespace chorus::server
