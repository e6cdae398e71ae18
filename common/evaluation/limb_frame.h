// Tracking orientations (Baak et al., 3.2): a coordinate system on a limb from what a tracker
// knows.
//
// Limb axes: +y along the bone towards the body's end of the limb's child joint (the trunk: up), +z
// ahead as far as it is seen, right-handed.  Each limb states what its axes come from:
//   pelvis, chest    the spine and the line through the hips or shoulders: all seen;
//   upper arm, thigh the bone and the plane it spans with the next bone: the twist of the limb
//   shows
//                    only while elbow or knee are bent;
//   forearm, shank   the same plane, from the other side; for a forearm the hinge shows the twist
//   of
//                    the elbow end, not the wrist's: the sensor sits near the wrist, so not seen;
//   foot             ankle to toe and the shank's plane; hand: the bone alone, twist by the thumb;
//   head             neck to head: the swing alone.
#pragma once

#include <array>
#include <optional>

#include "common/base/result.h"
#include "common/body/skeleton.h"
#include "common/evaluation/orientation_pair.h"
#include "common/inertial/limb.h"

namespace chorus::evaluation {

struct LimbFrameOptions {
  double joint_sigma = 0.03;  ///< Error of a joint where it states none [m]; cameras: 0.02 to 0.06.
  /// A bend of elbow or knee below this shows no twist [rad]: the plane's normal is then mostly
  /// error.
  double least_bend = 0.35;
};

/// Frame from three points that are not on one line: +y from `from` to `to`, `aside` in the y-z
/// plane on the +z side.  Refused where they are collinear or not finite.
[[nodiscard]] Result<Eigen::Quaterniond> frame_of_points(const Eigen::Vector3d& from,
                                                         const Eigen::Vector3d& to,
                                                         const Eigen::Vector3d& aside);

/// The limb's orientation in one body from the places of its joints; nothing if they are not seen.
[[nodiscard]] std::optional<TrackedOrientation> limb_from_joints(
    const Skeleton<WorldSpace>& body, inertial::Limb limb, const LimbFrameOptions& options = {});

/// The limb's orientation that the tracker itself states for the joint at the limb's end (a
/// kinematic chain: BVH, AMC, MVNX, a sensor's own body); nothing if it states none.
[[nodiscard]] std::optional<TrackedOrientation> limb_from_orientation(
    const Skeleton<WorldSpace>& body, inertial::Limb limb);

/// The joint at whose end the limb's bone ends: the one whose orientation is the limb's.
[[nodiscard]] JointId end_joint_of(inertial::Limb limb);

/// The joints that the limb's +y leads from and to.
struct LimbBone {
  JointId from;
  JointId to;
};
[[nodiscard]] LimbBone bone_of(inertial::Limb limb);

}  // namespace chorus::evaluation
