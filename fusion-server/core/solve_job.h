// What the registrar asks the worker thread to solve, and what comes back.
#pragma once

#include <cstdint>
#include <stop_token>

#include "common/base/duration.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/registration/registration.h"

namespace chorus::core {

/// A solve to be run by the worker thread.
struct SolveJob {
  std::uint64_t session = 0;
  SolveKind kind = SolveKind::Provisional;
  SharedWalk walk;
  registration::RegistrationConfig config;
  std::stop_token stop;  ///< Stopped when its result is no longer wanted.
};

struct Solution {
  std::uint64_t session = 0;
  SolveKind kind = SolveKind::Provisional;
  Registration registration;
  Duration cost{0};       ///< How long the solve took.
  bool given_up = false;  ///< True if the solve was stopped before its end: then there is no
                          ///< result.
};

/// The effect of a solution.
enum class Outcome {
  Nothing,    ///< The registration in use stays.
  Adopted,    ///< It was replaced or extended.
  Withdrawn,  ///< The session's own provisional registration was withdrawn.
};

}  // namespace chorus::core
