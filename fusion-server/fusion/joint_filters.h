// What methods that go through a body joint by joint share: the loop, and a filter for each joint.
#pragma once

#include <array>

#include "common/body/skeleton.h"
#include "fusion-server/fusion/joint_view.h"
#include "fusion-server/fusion/point_filter.h"

namespace chorus::fusion {

using JointFilters = std::array<PointFilter, kJointCount>;

/// Is the joint on the body's centre axis?
[[nodiscard]] bool in_trunk(JointId joint);

/// Density of the white acceleration of a joint: 3 for the trunk, 40 for limbs [m^2 / s^3].
[[nodiscard]] double process_density(JointId joint);

/// One filter per joint, with nothing seen, each with its joint's density.
[[nodiscard]] JointFilters joint_filters();

/// Puts a fused joint into its place in the body.
void put(FusedBody& body, JointId joint, const FusedJoint& fused);

/// The body of a person, `fuse_joint` being asked for each joint in their order.
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
