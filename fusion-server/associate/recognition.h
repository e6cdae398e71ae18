// Decides who a person is, by their build, when they appear or come back.
//
// While people are missing, a newcomer is not published until it is decided whether the newcomer is
// one of them: usually after AssociationConfig::recognise in view, sooner if many sensors see the
// newcomer or the builds differ too much.  A person who is found again after a gap keeps the id
// while the builds before and after the gap are compared.  If they are the builds of two people,
// the person found gets a new id, and the one from before the gap becomes missing under the old id.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// Adds the track to `tracks.missing`, unless its id was never published. If too many people are
/// missing, the first of them is dropped.
void miss(const Track& track, Tracks& tracks);

/// Forgets people who have been missing for too long.
void forget(Tracks& tracks, Timestamp instant, const AssociationConfig& config);

/// Forgets one person, whether they are here or missing; their id is never given again.
void forget(PersonId person, Tracks& tracks);

/// Decides everything that can be decided now.  A candidate who turns out to be a missing person
/// takes over that person's id; a track that had the id until then is removed.
void recognise(std::vector<Candidate>& candidates, Tracks& tracks, const AssociationConfig& config);

}  // namespace chorus::associate
