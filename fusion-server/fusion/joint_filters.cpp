#include "fusion-server/fusion/joint_filters.h"

#include <algorithm>
#include <utility>

#include "common/body/bones.h"

namespace chorus::fusion {
namespace {

constexpr double kTrunkDensity = 3.0;
constexpr double kLimbDensity = 40.0;

template <std::size_t... I>
JointFilters filters(std::index_sequence<I...>) {
  return {PointFilter(process_density(static_cast<JointId>(I)))...};
}

}  // namespace

bool in_trunk(JointId joint) { return std::ranges::find(kCoreJoints, joint) != kCoreJoints.end(); }

double process_density(JointId joint) { return in_trunk(joint) ? kTrunkDensity : kLimbDensity; }

JointFilters joint_filters() { return filters(std::make_index_sequence<kJointCount>{}); }

void put(FusedBody& body, JointId joint, const FusedJoint& fused) {
  const std::size_t i = index_of(joint);
  body.skeleton.joints[i] = fused.joint;
  body.variance[i] = fused.variance;
  body.contributors[i] = fused.contributors;
  body.shares[i] = fused.shares;
  body.age[i] = fused.age;
}

}  // namespace chorus::fusion
