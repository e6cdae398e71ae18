// The forearm where a sensor sits on it: pronation.
//
// A tracker's forearm turns with the elbow.  The hand turns about the same bone by up to 90 degrees
// more, and the skin between them by a share of that.  Two real sensors on forearms, compared with
// Vicon (TotalCapture S5 acting3, first 25 s; `chorus-bench inertial --only residual-real`): what
// they turn about the bone beyond Vicon's forearm correlates with the turn of Vicon's hand by 0.98
// and 0.99, with slopes of 0.75 and 0.69.  With a share of 0.7 the error that nine tenths stay
// below falls from 40 and 31 to 6 and 5 degrees; in the next 25 s, which nothing was chosen by,
// from 59 and 61 to 7 and 5.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "common/body/skeleton.h"
#include "common/evaluation/orientation_pair.h"
#include "common/inertial/limb.h"

namespace chorus::evaluation {

/// Of the hand's turn about the forearm's bone, at a sensor that is strapped near the wrist.
inline constexpr double kPronationShare = 0.7;

/// world_from_limb of the forearm where the sensor sits.  `bone` is the bone's direction in the
/// forearm's axes.  A hand that is turned by more than 150 degrees is none: then the forearm
/// itself.
[[nodiscard]] Eigen::Quaterniond forearm_at_sensor(
    const Eigen::Quaterniond& world_from_forearm, const Eigen::Quaterniond& world_from_hand,
    const Eigen::Vector3d& bone = Eigen::Vector3d::UnitY());

/// limb_from_orientation() where a sensor sits on the limb: a forearm turns with its hand, if the
/// body states the hand's orientation.
[[nodiscard]] std::optional<TrackedOrientation> limb_under_sensor(const Skeleton<WorldSpace>& body,
                                                                  inertial::Limb limb);

}  // namespace chorus::evaluation
