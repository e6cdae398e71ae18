// Bodies that cameras without depth show: whose they are, and where.
//
// One such view has no place.  Whether it shows somebody who is tracked already is the distance of
// its rays from the joints of the track: that takes size and posture into account, so that somebody
// behind another is told apart.  New people are founded where rays of two cameras meet, joint by
// joint (epipolar consistency), preferring hypotheses that more cameras agree with.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fusion-server/associate/placed_view.h"
#include "fusion-server/associate/plausible.h"

namespace chorus::associate {

/// Where the joints of a person are, as far as known; world [m].
using Located = std::array<std::optional<Eigen::Vector3d>, kJointCount>;

/// The joints that have a place.
[[nodiscard]] Located points_of(const Skeleton<WorldSpace>& body);

/// Per joint the mean of the points, or where two or more rays meet.
[[nodiscard]] Located locate(const std::vector<PlacedView>& views);

/// Mean of the core joints, of all if there is none; nothing when no joint is located.
[[nodiscard]] std::optional<Eigen::Vector3d> middle_of(const Located& body);

/// Median distance of the rays of a view from the joints of a body that has moved by `shift` [m];
/// nothing when they have fewer than three joints in common.
[[nodiscard]] std::optional<double> misfit(const SensorView& view, const Located& body,
                                           const Eigen::Vector3d& shift);

/// The same for a track of which only the core is known.
[[nodiscard]] std::optional<double> misfit(const SensorView& view, const Eigen::Vector3d& core);

/// Views of rays that show the same person, one per sensor, at least two.  `limit`: median distance
/// of the rays beyond which they are not one person's [m].  Views that nothing fits are left out.
[[nodiscard]] std::vector<std::vector<PlacedView>> meet(std::vector<PlacedView> views, double limit,
                                                        const BodyLimits& bodies);

}  // namespace chorus::associate
