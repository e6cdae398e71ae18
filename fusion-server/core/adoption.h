// What a new solve may change in the registration in use.
//
// Sensors that stand well are held: a solve that places one more of them moves none of the others.
#pragma once

#include <set>

#include "common/base/result.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/flow.h"

namespace chorus::core {

/// Its own verdict; without one, that of the whole registration.  None: it has no place.
[[nodiscard]] Verdict verdict_of(const Registration& registration, const SensorId& sensor);

/// Whether the candidate as a whole should replace what we have: never a refused one, never a worse
/// verdict or a smaller circle of sensors.  `Final` candidates of equal standing replace, so that a
/// new walk counts.
[[nodiscard]] bool should_replace(const Registration& current, const Registration& candidate,
                                  SolveKind kind);

/// The places in use, and beside them those of sensors that only the candidate places well (at the
/// end of a walk: places at all), moved into the world of the held ones.  NotFound: it adds nobody;
/// Conflict: the held ones do not stand to one another as the walk says.
[[nodiscard]] Result<Registration> extended(const Registration& current,
                                            const Registration& candidate, SolveKind kind);

/// What is in use after this solve; an error: as before.  `hold`: sensors that stand well stay
/// where they are even if the candidate as a whole is as good.
[[nodiscard]] Result<Registration> adopted(const Registration& current,
                                           const Registration& candidate, SolveKind kind,
                                           bool hold);

/// Tells of each sensor that the candidate could not place and that has no place, why.
void note_refusals(Registration& current, const Registration& candidate);

/// The sensors among `seeing` (those that saw a body lately) that have no place.
[[nodiscard]] std::set<SensorId> unplaced(const Registration& current,
                                          const std::set<SensorId>& seeing);

}  // namespace chorus::core
