// What a new solve may change in the current registration.
//
// Sensors that are placed well are held: a solve that adds another sensor moves none of them.
#pragma once

#include <set>
#include <string>

#include "common/base/result.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/flow/registration.h"

namespace chorus::core {

/// Why extended() refuses a walk, and what stays a reason of the registration in use until another
/// one replaces it.
extern const char* const kContradicted;

/// The sensor's own verdict, or that of the whole registration.  None: the sensor has no place.
[[nodiscard]] Verdict verdict_of(const Registration& registration, const SensorId& sensor);

/// Whether the candidate should replace the whole registration: not if it is refused or places no
/// sensor; always if the current one is refused or places none. Otherwise it must place all sensors
/// of the current one. Then a better verdict replaces it; so does an equal one if `kind` is Final,
/// so that a new walk has an effect, or if both are provisional, but only if it places no sensor
/// worse where it stands: a short walk after a long one leaves the places as they are.
[[nodiscard]] bool should_replace(const Registration& current, const Registration& candidate,
                                  SolveKind kind);

/// The current places, with the candidate's place for each sensor that has none, so that it is in
/// use after the first seconds of a walk, and for each one that does not stand well and that the
/// candidate places well, by a clearly smaller radius, or (at the end of a walk) where it was moved
/// to.  Places from the candidate are moved into the world of the held sensors.  NotFound: there is
/// no such sensor, or one of the two registrations is refused or empty.  Conflict, with
/// kContradicted: the walk contradicts the places of the held sensors relative to one another.
[[nodiscard]] Result<Registration> extended(const Registration& current,
                                            const Registration& candidate, SolveKind kind);

/// The registration to use after this solve, in the world of the current one (world.h); on an error
/// the current one stays. `hold`: if any sensor is placed well, the current registration is only
/// extended, however good the candidate is.
[[nodiscard]] Result<Registration> adopted(const Registration& current,
                                           const Registration& candidate, SolveKind kind,
                                           bool hold);

/// What may be used without asking: the registration without its unconfirmed places, whose sensors
/// are refused with that reason.
[[nodiscard]] Registration confirmed_part(Registration candidate);

/// Notes the reason for each sensor that neither the registration nor the candidate could place.
void note_refusals(Registration& current, const Registration& candidate);

/// Notes that the last walk contradicted the places: kContradicted.
void note_contradiction(Registration& current);

/// The registration without the place of this sensor, which was moved; the sensor is refused with
/// `reason`.  If it was the master, the best of the others becomes the master.
[[nodiscard]] Registration without(Registration current, const SensorId& sensor,
                                   const std::string& reason);

/// Removes what concerns sensors that are not configured any more.  If the master is one of them,
/// the best of the others becomes the master, because a registration without its master could not
/// be read again.
void keep_configured(Registration& registration, const std::set<SensorId>& sensors);

/// The sensors among `seeing` (those that saw a body lately) that have no place.
[[nodiscard]] std::set<SensorId> unplaced(const Registration& current,
                                          const std::set<SensorId>& seeing);

}  // namespace chorus::core
