// Who somebody is who came, or came back: told by their build.
//
// While somebody is missing, a newcomer gets no id before it is known whether they are that person:
// after AssociationConfig::recognise of sight at the latest, sooner when their builds differ so
// much that they cannot be.  Somebody lost and found keeps the id meanwhile, and loses it to
// whoever was lost when they turn out to be somebody else.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// Into `tracks.missing`, unless it never got an id that anybody knows.
void miss(const Track& track, Tracks& tracks);

/// Forgets those who have been away for too long.
void forget(Tracks& tracks, Timestamp instant, const AssociationConfig& config);

/// Answers what can be answered now.  Candidates that turn out to be somebody else's continuation
/// take over the id, and the one that it is taken from goes.
void recognise(std::vector<Candidate>& candidates, Tracks& tracks, const AssociationConfig& config);

}  // namespace chorus::associate
