#include "common/layout/layout.h"

#include <algorithm>
#include <string>
#include <utility>

#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

constexpr std::array kLayouts{
    &kKinectV2, &kAzureKinect, &kMediapipe, &kCoco17, &kCoco18,   &kBody25,
    &kHalpe26,  &kZed18,       &kZed34,     &kZed38,  &kNuitrack, &kOrbbecAstra,
};

const Landmark& landmark_at(std::span<const Landmark> landmarks, std::size_t index) {
  static const Landmark missing;
  return index < landmarks.size() ? landmarks[index] : missing;
}

/// Adds the landmark's part to the joint; false when the landmark is not tracked, or when one of
/// the two is a ray and the other a point.
bool add(Joint& joint, const Share& share, const Landmark& landmark) {
  const bool other_kind = landmark.measurement != joint.measurement;
  if (landmark.state == JointState::NotTracked || !landmark.position.allFinite() || other_kind)
    return false;
  joint.state = std::min(joint.state, landmark.state);
  joint.position += share.weight * landmark.position;
  return true;
}

/// Covariance of a weighted mean of independent landmarks: the sum of w^2 C.
Covariance covariance_of(const Recipe& recipe, std::span<const Landmark> landmarks) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Share& share : recipe.shares) {
    if (share.weight == 0.0) continue;
    const Covariance& one = landmark_at(landmarks, share.landmark).covariance;
    if (!one.known()) return {};
    sum += share.weight * share.weight * one.matrix();
  }
  return Covariance(sum);
}

Joint joint_of(const Recipe& recipe, std::span<const Landmark> landmarks) {
  Joint joint;
  joint.state = JointState::Tracked;
  joint.measurement = landmark_at(landmarks, recipe.shares.front().landmark).measurement;
  for (const Share& share : recipe.shares) {
    if (share.weight == 0.0) continue;
    if (!add(joint, share, landmark_at(landmarks, share.landmark))) return {};
  }
  if (joint.measurement == Measurement::Ray) {
    if (joint.position.norm() == 0.0) return {};
    joint.position.normalize();
  }
  joint.covariance = covariance_of(recipe, landmarks);
  return joint;
}

}  // namespace

std::span<const Layout* const> layouts() { return kLayouts; }

Result<const Layout*> find_layout(std::string_view name) {
  std::string known;
  for (const Layout* layout : kLayouts) {
    if (layout->name == name) return layout;
    known.append(known.empty() ? "" : ", ").append(layout->name);
  }
  constexpr std::size_t kShown = 64;
  return fail(ErrorCode::NotFound, std::string(name.substr(0, kShown)),
              "there is no such layout; the known ones are " + known);
}

std::optional<std::size_t> landmark_named(const Layout& layout, std::string_view name) {
  const auto it = std::find(layout.landmarks.begin(), layout.landmarks.end(), name);
  if (it == layout.landmarks.end()) return std::nullopt;
  return static_cast<std::size_t>(it - layout.landmarks.begin());
}

JointState state_of(double confidence, double tracked_from, double inferred_from) {
  if (confidence >= tracked_from) return JointState::Tracked;
  return confidence >= inferred_from ? JointState::Inferred : JointState::NotTracked;
}

std::array<Joint, kJointCount> joints_of(const Layout& layout,
                                         std::span<const Landmark> landmarks) {
  std::array<Joint, kJointCount> joints;
  std::array<bool, kJointCount> tried{};
  for (const Recipe& recipe : layout.recipes) {
    const std::size_t i = index_of(recipe.joint);
    const bool stand_in = std::exchange(tried[i], true);
    if (joints[i].state != JointState::NotTracked) continue;
    joints[i] = joint_of(recipe, landmarks);
    if (stand_in) joints[i].state = std::min(joints[i].state, JointState::Inferred);
  }
  if (const auto turn = head_turn(layout, landmarks))
    joints[index_of(JointId::Head)].orientation = *turn;
  return joints;
}

std::optional<Eigen::Quaterniond> head_turn(const Layout& layout,
                                            std::span<const Landmark> landmarks) {
  const HeadMarks& marks = layout.head;
  if (!marks.known()) return std::nullopt;
  for (const std::uint8_t mark :
       {marks.nose, marks.left_eye, marks.right_eye, marks.left_ear, marks.right_ear}) {
    const Landmark& landmark = landmark_at(landmarks, mark);
    if (landmark.state == JointState::NotTracked || landmark.measurement != Measurement::Point ||
        !landmark.position.allFinite())
      return std::nullopt;
  }
  const auto at = [&](std::uint8_t mark) { return landmark_at(landmarks, mark).position; };
  const Eigen::Vector3d across = at(marks.left_ear) - at(marks.right_ear);
  const Eigen::Vector3d face = (at(marks.nose) + at(marks.left_eye) + at(marks.right_eye)) / 3.0 -
                               0.5 * (at(marks.left_ear) + at(marks.right_ear));
  const Eigen::Vector3d up = face.cross(across);
  // Less than a tenth of a head's ears by its face: all on a line.
  if (!(across.norm() > 0.01) || !(up.norm() > 1e-3)) return std::nullopt;
  Eigen::Matrix3d turn;
  turn.col(0) = across.normalized();
  turn.col(1) = up.normalized();
  turn.col(2) = turn.col(0).cross(turn.col(1));
  return Eigen::Quaterniond(turn);
}

}  // namespace chorus::layout
