// Computes where a track is expected, and how its views update it.
//
// An unseen person is not assumed to walk on for ever: the speed decays, and the area in which the
// person is looked for grows.  Speed is computed, joint by joint, from bodies that a sensor showed
// at both instants: otherwise sensors and joints that come and go would look like motion.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

[[nodiscard]] Candidate predict(const Track& track, Timestamp instant,
                                const AssociationConfig& config);

/// Updates the candidate by its views, and cuts its build (tracklets.h) where nobody placed it
/// before or all bodies that show it are new.  Without views the track stays as it was; a camera
/// without depth that alone sees the person moves it across its rays.
void update(Candidate& candidate, Timestamp instant);

/// Puts the track of a person whom such a camera alone sees where fusion has the joints, because
/// fusion knows how far away they are by their size.
void follow(Tracks& tracks, PersonId person, const Located& joints);

}  // namespace chorus::associate
