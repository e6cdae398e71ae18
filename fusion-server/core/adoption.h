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

/// Whether the candidate should replace the whole registration: never a refused one, never one with
/// a worse verdict or fewer sensors.  `Final` candidates that are as good replace, so that a new
/// walk counts.
[[nodiscard]] bool should_replace(const Registration& current, const Registration& candidate,
                                  SolveKind kind);

/// The places in use, plus those of sensors that only the candidate places well (at the end of a
/// walk: places at all), moved into the world of the held ones.  NotFound: it adds no sensor;
/// Conflict: the held sensors do not stand to one another as the walk says.
[[nodiscard]] Result<Registration> extended(const Registration& current,
                                            const Registration& candidate, SolveKind kind);

/// The registration in use after this solve; on an error it stays.  `hold`: sensors that stand well
/// stay where they are even if the candidate as a whole is as good.
[[nodiscard]] Result<Registration> adopted(const Registration& current,
                                           const Registration& candidate, SolveKind kind,
                                           bool hold);

/// Says, for each sensor without a place that the candidate could not place either, why.
void note_refusals(Registration& current, const Registration& candidate);

/// The sensors among `seeing` (those that saw a body lately) that have no place.
[[nodiscard]] std::set<SensorId> unplaced(const Registration& current,
                                          const std::set<SensorId>& seeing);

}  // namespace chorus::core
