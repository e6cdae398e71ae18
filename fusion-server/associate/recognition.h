// Decides by their build who a person is who has appeared or come back.
//
// While people are missing, a newcomer gets no id until it is known whether they are one of them:
// after AssociationConfig::recognise of sight at the latest, sooner if their builds differ too
// much.  A person lost and found keeps the id meanwhile, and gives it back to the lost person if
// the builds show that they are different people.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// Adds the track to `tracks.missing`, unless its id was never published.
void miss(const Track& track, Tracks& tracks);

/// Forgets people who have been missing for too long.
void forget(Tracks& tracks, Timestamp instant, const AssociationConfig& config);

/// Decides whatever can be decided now.  A candidate that turns out to be a missing person takes
/// over that person's id; a track that had the id until then is removed.
void recognise(std::vector<Candidate>& candidates, Tracks& tracks, const AssociationConfig& config);

}  // namespace chorus::associate
