// Shared by methods that fuse a body joint by joint: the loop, and one filter per joint.
#pragma once

#include <array>

#include "common/body/skeleton.h"
#include "fusion-server/flow/fused_body.h"
#include "fusion-server/fusion/joint_view.h"
#include "fusion-server/fusion/point_filter.h"

namespace chorus::fusion {

using JointFilters = std::array<PointFilter, kJointCount>;

/// True if the joint is on the body's centre axis.
[[nodiscard]] bool in_trunk(JointId joint);

/// Spectral density of a joint's white-noise acceleration: 3 for trunk, 40 for limbs [m^2 / s^3].
[[nodiscard]] double process_density(JointId joint);

/// One filter per joint, without measurements yet, each with its joint's process density.
[[nodiscard]] JointFilters joint_filters();

/// Writes a fused joint into the body.
void put(FusedBody& body, JointId joint, const FusedJoint& fused);

/// The body of a person; `fuse_joint` is called for each joint in order.
template <class FuseJoint>
[[nodiscard]] FusedBody joint_by_joint(PersonId person, const FuseJoint& fuse_joint) {
  FusedBody body;
  body.id = person;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto joint = static_cast<JointId>(i);
    put(body, joint, fuse_joint(joint));
  }
  return body;
}

}  // namespace chorus::fusion
