// Assigns the bodies of cameras without depth to people and locates them.
//
// One such view has no place.  Whether it shows a tracked person is judged by the distance of its
// rays from the joints of the track: this takes size and posture into account, so that two people
// in line are told apart.  New people are found where rays of two cameras meet, joint by joint
// (epipolar consistency), preferring hypotheses that more cameras support.
#pragma once

#include <optional>
#include <vector>

#include "common/body/located.h"
#include "fusion-server/associate/placed_view.h"
#include "fusion-server/associate/plausible.h"

namespace chorus::associate {

/// Per joint the mean of the points, or the point where two or more rays meet.
[[nodiscard]] Located locate(const std::vector<PlacedView>& views);

/// Median distance of a view's rays from the joints of a body that has moved by `shift` [m];
/// nothing when they have fewer than three joints in common.
[[nodiscard]] std::optional<double> misfit(const SensorView& view, const Located& body,
                                           const Eigen::Vector3d& shift);

/// The same for a track of which only the core is known.
[[nodiscard]] std::optional<double> misfit(const SensorView& view, const Eigen::Vector3d& core);

/// Groups of ray views that show the same person, at most one per sensor, at least two.  `limit`:
/// greatest median distance of rays of one person [m].  Views that fit no other are left out.
[[nodiscard]] std::vector<std::vector<PlacedView>> meet(std::vector<PlacedView> views, double limit,
                                                        const BodyLimits& bodies);

}  // namespace chorus::associate
