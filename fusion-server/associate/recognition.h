// Decides who the people in view are, by their builds and by the inertial sensors that they wear,
// at every instant.
//
// The persons in question are newcomers while people are missing, and those whose build suggests
// that a sensor went over to somebody else (tracklets.h), or who do not move as their sensors say
// (worn_likeness.h).  Who they may be: people who are missing
// or out of sight, persons in question as they were before, and somebody new.  All questions are
// answered together, so that the sum of the log odds is greatest; two people who took each other's
// place get their ids back at once.  An answer counts when one alternative is much likelier than
// all others, or after about a second in view.  A track that changed its person is split where that
// happened: what was before it becomes missing under the old id.
//
// Only somebody whose build is known can be missing; whoever was seen too briefly, or with too few
// joints, cannot be recognised and keeps nobody waiting.
#pragma once

#include <vector>

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"
#include "fusion-server/flow/correction.h"
#include "fusion-server/flow/worn_people.h"

namespace chorus::associate {

/// Adds the track's person to `tracks.missing`, if they can be recognised and their id was
/// published.  If too many people are missing, the first of them is dropped.
void miss(const Track& track, Tracks& tracks);

/// Forgets people who have been missing for too long.
void forget(Tracks& tracks, Timestamp instant, const AssociationConfig& config);

/// Forgets one person, whether they are here or missing; their id is never given again.
void forget(PersonId person, Tracks& tracks);

struct Asked {
  Timestamp at;
  const WornPeople& worn;
};

/// Decides everything that can be decided now, and returns which published ids were another's.  A
/// candidate who turns out to be a missing person takes over that person's id; a track that had the
/// id until then is removed.
std::vector<Correction> recognise(std::vector<Candidate>& candidates, Tracks& tracks,
                                  const Asked& asked, const AssociationConfig& config);

}  // namespace chorus::associate
