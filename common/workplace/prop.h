// A prop: a rigid body that somebody holds in a hand, in both hands, or wears at another joint.
//
// World space, metres, +y against gravity.  The grip is the frame in which the prop rests:
//   one joint   origin at the joint, +z along the limb that ends there (elbow to hand), +y up
//               across it; of the head, the head's own orientation where it is known
//   two joints  origin in their middle, +x from the second to the first (right to left hand), +z
//               along the mean of the two limbs, across x; `level`: +y up, +x the level part of
//               that line, since people hold a box by an upper and a lower corner
// The turn about a single limb is not measured by any joint: it is taken to be level.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/config_reader.h"
#include "common/body/skeleton.h"

namespace chorus::workplace {

inline constexpr std::size_t kMaxProps = 32;

struct Prop {
  std::string name;  ///< Letters, digits, '-' and '_'; at most 32; not Body...
  JointId joint = JointId::HandRight;
  std::optional<JointId> other;                      ///< Of a pair: the second joint.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< Of the prop's origin, in the grip [m].
  double yaw = 0.0;                                  ///< Of the prop in the grip, about +y [rad].
  double pitch = 0.0;                                ///< Then about its +x [rad].
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< Of the box around it [m]; 0: not told.
  bool level = false;                                ///< Its +y stays up, as that of a full box.

  bool operator==(const Prop&) const = default;
};

/// Where a prop is.
struct PropPose {
  Eigen::Isometry3d world_from_prop = Eigen::Isometry3d::Identity();
  double sigma = 0.0;       ///< Of the place, per axis [m]; 0: no joint stated its doubt.
  double turn_sigma = 0.0;  ///< Of the orientation [rad]; 0: likewise.
};

[[nodiscard]] Eigen::Isometry3d grip_from_prop(const Prop& prop);

/// The joint from which the limb that ends in `joint` begins: the elbow of a hand.
[[nodiscard]] JointId lever_of(JointId joint);

/// Whether a sensor determines the joint: tracked, and stated to within 0.15 m.
[[nodiscard]] bool well_seen(const Joint& joint);

/// The grip of a body as it stands; none while joints that it needs are not seen.
[[nodiscard]] std::optional<PropPose> grip_of(const Skeleton<WorldSpace>& body, const Prop& prop);

/// Reads the key "props": objects with name, joints (one or two names), offset_m, yaw_deg,
/// pitch_deg, size_m, level.  Mistakes become the reader's problems.
[[nodiscard]] std::vector<Prop> read_props(ConfigReader& reader);

}  // namespace chorus::workplace
