#include "fusion-server/pipeline/head_turns.h"

#include <algorithm>

#include "common/geometry/rotation.h"
#include "common/posture/spread.h"

namespace chorus::pipeline {
namespace {

/// The rotation vector, in the world, that takes one orientation to the other [rad].
Eigen::Vector3d turned(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::AngleAxisd by(to * from.conjugate());
  return by.angle() * by.axis();
}

void state_head_turn(const Person& person, FusedBody& body) {
  const std::size_t head = index_of(JointId::Head);
  const Eigen::Quaterniond& fused = body.skeleton.joints[head].orientation;
  if (!is_unit(fused) || body.orientation_covariance[head].known()) return;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double views = 0.0;
  for (const SensorView& view : person.views) {
    const Joint& seen = view.skeleton.joints[head];
    if (!seen.given() || !is_unit(seen.orientation)) continue;
    const Eigen::Vector3d off = turned(fused, seen.orientation);
    spread += off * off.transpose();
    ++views;
  }
  if (views == 0.0) return;
  constexpr double kMarks = posture::kHeadTurn * posture::kHeadTurn;
  body.orientation_covariance[head] =
      Covariance(Eigen::Matrix3d(kMarks * Eigen::Matrix3d::Identity() + spread / views));
}

}  // namespace

void state_head_turns(const std::vector<Person>& people, std::vector<FusedBody>& bodies) {
  for (FusedBody& body : bodies) {
    const auto person = std::ranges::find(people, body.id, &Person::id);
    if (person != people.end()) state_head_turn(*person, body);
  }
}

}  // namespace chorus::pipeline
