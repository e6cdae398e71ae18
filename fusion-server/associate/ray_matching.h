// Assigns the bodies of cameras without depth to people, and locates them.
//
// A single ray body has no place.  The distance of its rays from the joints of a track decides
// whether it shows that person.  This accounts for size and posture, so two people in one line of
// sight can be distinguished.  New people are found where rays of two cameras meet, joint by joint
// (epipolar consistency); hypotheses that more cameras support are preferred.
#pragma once

#include <optional>
#include <vector>

#include "common/body/located.h"
#include "fusion-server/associate/placed_view.h"
#include "fusion-server/associate/plausible.h"

namespace chorus::associate {

/// For each joint, the mean of the views' points, or, if there are none, the point where two or
/// more rays meet.
[[nodiscard]] Located locate(const std::vector<PlacedView>& views);

/// Median distance [m] of a view's rays from the joints of a body that has moved by `shift`; none
/// when view and body have fewer than three joints in common.
[[nodiscard]] std::optional<double> misfit(const SensorView& view, const Located& body,
                                           const Eigen::Vector3d& shift);

/// The same for a track of which only the core is known: the distance of the mean ray of the view's
/// core joints; none if it has none.
[[nodiscard]] std::optional<double> misfit(const SensorView& view, const Eigen::Vector3d& core);

/// Groups ray views that show the same person: at least two views, at most one per sensor.
/// `limit`: greatest median distance of the rays of one person [m].  Views that fit no other are
/// left out.
[[nodiscard]] std::vector<std::vector<PlacedView>> meet(std::vector<PlacedView> views, double limit,
                                                        const BodyLimits& bodies);

}  // namespace chorus::associate
