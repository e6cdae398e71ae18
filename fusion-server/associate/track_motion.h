// Where a track is expected, and what it learns from the views that turn out to be its own.
//
// Nobody who is not seen walks on for ever: speed decays, and the place in which they are looked
// for grows.  Speed is told from bodies that a sensor showed at both instants, joint by joint;
// which sensors and which joints there are changes from instant to instant, and would fake some.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// On the floor [m]: people do not stand on one another, and an occluded hip must not lift a body
/// away from its track.
[[nodiscard]] double horizontal_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

[[nodiscard]] Candidate predict(const Track& track, Timestamp instant,
                                const AssociationConfig& config);

/// Takes in the candidate's sights, if there are any.  A track that only one camera without depth
/// sees stays where it is expected, as long as tracks survive unseen.
void update(Candidate& candidate, Timestamp instant, const AssociationConfig& config);

}  // namespace chorus::associate
