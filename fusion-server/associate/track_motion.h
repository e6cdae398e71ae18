// Where a track is expected, and how its own views update it.
//
// An unseen person does not walk on forever: the speed decays, and the area in which they are
// looked for grows.  Speed is computed from bodies that a sensor showed at both instants, joint by
// joint, because a changing set of sensors and joints would fake motion.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// Horizontal distance [m]: people do not stand on one another, and an occluded hip must not lift a
/// body away from its track.
[[nodiscard]] double horizontal_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

[[nodiscard]] Candidate predict(const Track& track, Timestamp instant,
                                const AssociationConfig& config);

/// Updates the candidate by its views, if it has any.  A track seen by only one camera without
/// depth stays at its expected place, as long as unseen tracks survive.
void update(Candidate& candidate, Timestamp instant, const AssociationConfig& config);

}  // namespace chorus::associate
