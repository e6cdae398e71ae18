#include "common/exporters/skeleton_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <Eigen/SVD>

#include "common/base/median.h"
#include "common/body/bones.h"

namespace chorus::exporters {
namespace {

constexpr double kMinBone = 1e-4;           // [m]; a shorter bone has no direction
constexpr int kProcrustesRounds = 3;        // After this many rounds the shape hardly changes.
constexpr std::size_t kShapeFrames = 2000;  // enough for a mean shape
constexpr double kFootOut = 0.3;

/// The direction, in the T-pose, of the bone that ends at a joint; left is +x, ahead is +z.
Eigen::Vector3d t_pose_direction(JointId end) {
  struct Row {
    JointId left;
    JointId right;
    double x, y, z;  ///< For the left joint; x is mirrored for the right.
  };
  constexpr Row kRows[] = {
      {JointId::HipLeft, JointId::HipRight, 1, -0.4, 0},
      {JointId::KneeLeft, JointId::KneeRight, 0, -1, 0},
      {JointId::AnkleLeft, JointId::AnkleRight, 0, -1, 0},
      {JointId::FootLeft, JointId::FootRight, 0, -kFootOut, 1},
      {JointId::ShoulderLeft, JointId::ShoulderRight, 1, -0.2, 0},
      {JointId::ElbowLeft, JointId::ElbowRight, 1, 0, 0},
      {JointId::WristLeft, JointId::WristRight, 1, 0, 0},
      {JointId::HandLeft, JointId::HandRight, 1, 0, 0},
      {JointId::HandTipLeft, JointId::HandTipRight, 1, 0, 0},
      {JointId::ThumbLeft, JointId::ThumbRight, 1, 0, 1},
  };
  for (const Row& row : kRows) {
    if (end == row.left) return Eigen::Vector3d(row.x, row.y, row.z).normalized();
    if (end == row.right) return Eigen::Vector3d(-row.x, row.y, row.z).normalized();
  }
  return Eigen::Vector3d::UnitY();  // the spine points up
}

/// Median distance between two joints over the frames that have both; none if there is no such
/// frame.
std::optional<double> bone_length(const PersonTrack& track, JointId a, JointId b) {
  std::vector<double> lengths;
  for (const Pose& pose : track.poses) {
    if (pose.skeleton[a].seen() && pose.skeleton[b].seen())
      lengths.push_back((pose.skeleton[a].position - pose.skeleton[b].position).norm());
  }
  if (lengths.empty()) return std::nullopt;
  return median(std::move(lengths));
}

using Children = std::vector<std::vector<std::size_t>>;

Children children_of(const std::vector<FittedJoint>& joints) {
  Children children(joints.size());
  for (std::size_t i = 1; i < joints.size(); ++i) children[joints[i].parent].push_back(i);
  return children;
}

/// The tree of all joints that were ever seen together with the joint that they hang on, with
/// T-pose offsets of the median lengths.
std::vector<FittedJoint> tree_of(const PersonTrack& track) {
  std::vector<FittedJoint> joints{{JointId::SpineBase, 0, Eigen::Vector3d::Zero()}};
  // Where the children of each joint are attached: to the joint itself, or to its parent if the
  // joint was left out.
  std::array<std::size_t, kJointCount> stands_for{};
  for (const Bone& bone : kBones) {
    const std::size_t parent = stands_for[index_of(bone.parent)];
    const auto length = bone_length(track, joints[parent].id, bone.child);
    stands_for[index_of(bone.child)] = length ? joints.size() : parent;
    if (length) joints.push_back({bone.child, parent, *length * t_pose_direction(bone.child)});
  }
  return joints;
}

/// The rotation nearest to `cross`, the sum of target * source^T (Kabsch).
Eigen::Quaterniond nearest_rotation(const Eigen::Matrix3d& cross) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turn = svd.matrixU() * svd.matrixV().transpose();
  if (turn.determinant() < 0) {
    Eigen::Matrix3d mirror = Eigen::Vector3d(1, 1, -1).asDiagonal();
    turn = svd.matrixU() * mirror * svd.matrixV().transpose();
  }
  return Eigen::Quaterniond(turn).normalized();
}

/// Bones at rest and the same bones as seen, for those children of a joint that are seen.
struct BonePairs {
  std::vector<Eigen::Vector3d> rest;
  std::vector<Eigen::Vector3d> seen;
};

Eigen::Quaterniond turn_between(const BonePairs& pairs, const Eigen::Quaterniond& likely) {
  // A tiny weight on the likely rotation determines what the children leave undetermined, and
  // hardly affects the rest.
  constexpr double kLikely = 1e-6;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < pairs.rest.size(); ++i)
    cross += pairs.seen[i] * pairs.rest[i].transpose();
  return nearest_rotation(cross + kLikely * cross.norm() * likely.toRotationMatrix());
}

/// Points the rest offset of each child in the mean direction in which that child was seen, over a
/// sample of the frames in which all children were seen, each turned back to the rest pose.  The
/// lengths of the bones stay.
void average_shape(const PersonTrack& track, std::vector<FittedJoint>& joints, std::size_t joint,
                   const std::vector<std::size_t>& children) {
  std::vector<Eigen::Vector3d> sums(children.size(), Eigen::Vector3d::Zero());
  const std::size_t stride = track.poses.size() / kShapeFrames + 1;
  for (std::size_t f = 0; f < track.poses.size(); f += stride) {
    const auto& body = track.poses[f].skeleton;
    BonePairs pairs;
    for (const std::size_t child : children) {
      if (!body[joints[child].id].seen() || !body[joints[joint].id].seen()) break;
      pairs.rest.push_back(joints[child].offset);
      pairs.seen.push_back(body[joints[child].id].position - body[joints[joint].id].position);
    }
    if (pairs.rest.size() != children.size()) continue;
    const Eigen::Quaterniond world_from_rest = turn_between(pairs, Eigen::Quaterniond::Identity());
    for (std::size_t c = 0; c < children.size(); ++c)
      sums[c] += world_from_rest.conjugate() * pairs.seen[c];
  }
  for (std::size_t c = 0; c < children.size(); ++c) {
    Eigen::Vector3d& offset = joints[children[c]].offset;
    if (sums[c].norm() > kMinBone) offset = offset.norm() * sums[c].normalized();
  }
}

/// Computes the poses in order and remembers the last one.
class ChainFollower {
 public:
  explicit ChainFollower(const std::vector<FittedJoint>& joints)
      : joints_(joints), children_(children_of(joints)) {
    pose_.turns.assign(joints.size(), Eigen::Quaterniond::Identity());
  }

  const FittedPose& follow(const Skeleton<WorldSpace>& body);

 private:
  [[nodiscard]] Eigen::Quaterniond turn_of(std::size_t joint, const Skeleton<WorldSpace>& body,
                                           const Eigen::Quaterniond& world_from_parent,
                                           const Eigen::Vector3d& place) const;

  const std::vector<FittedJoint>& joints_;
  Children children_;
  FittedPose pose_;
};

Eigen::Quaterniond ChainFollower::turn_of(std::size_t joint, const Skeleton<WorldSpace>& body,
                                          const Eigen::Quaterniond& world_from_parent,
                                          const Eigen::Vector3d& place) const {
  BonePairs pairs;
  for (const std::size_t child : children_[joint]) {
    const Joint& wanted = body[joints_[child].id];
    const Eigen::Vector3d seen = world_from_parent.conjugate() * (wanted.position - place);
    if (!wanted.seen() || seen.norm() < kMinBone || joints_[child].offset.norm() < kMinBone)
      continue;
    pairs.rest.push_back(joints_[child].offset);
    pairs.seen.push_back(seen);
  }
  const Eigen::Quaterniond& last = pose_.turns[joint];
  if (pairs.rest.empty()) return last;
  if (pairs.rest.size() > 1) return turn_between(pairs, last);
  // A joint with a single child turns by the shortest arc from rest, whatever the last pose was;
  // one with several children, of which one is visible, from the last pose.
  const bool alone = children_[joint].size() == 1;
  const Eigen::Quaterniond start = alone ? Eigen::Quaterniond::Identity() : last;
  return Eigen::Quaterniond::FromTwoVectors(start * pairs.rest[0], pairs.seen[0]) * start;
}

const FittedPose& ChainFollower::follow(const Skeleton<WorldSpace>& body) {
  if (!body[JointId::SpineBase].seen()) return pose_;
  pose_.root = body[JointId::SpineBase].position;
  std::vector<Eigen::Quaterniond> world_from_joint(joints_.size());
  std::vector<Eigen::Vector3d> places(joints_.size(), pose_.root);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const std::size_t parent = joints_[i].parent;
    const Eigen::Quaterniond world_from_parent =
        i == 0 ? Eigen::Quaterniond::Identity() : world_from_joint[parent];
    if (i > 0) places[i] = places[parent] + world_from_parent * joints_[i].offset;
    Eigen::Quaterniond turn = turn_of(i, body, world_from_parent, places[i]).normalized();
    if (turn.dot(pose_.turns[i]) < 0) turn.coeffs() = -turn.coeffs();
    pose_.turns[i] = turn;
    world_from_joint[i] = (world_from_parent * turn).normalized();
  }
  return pose_;
}

FitResidual residual_of(const SkeletonFit& fit, const PersonTrack& track) {
  FitResidual out;
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t f = 0; f < track.poses.size(); ++f) {
    const auto& body = track.poses[f].skeleton;
    if (!body[JointId::SpineBase].seen()) continue;
    const auto places = chain_positions(fit, fit.poses[f]);
    for (std::size_t i = 0; i < fit.joints.size(); ++i) {
      const Joint& joint = body[fit.joints[i].id];
      if (!joint.seen()) continue;
      const double distance = (places[i] - joint.position).norm();
      squares += distance * distance;
      ++count;
      if (distance > out.largest) out = {out.rms, distance, fit.joints[i].id, f};
    }
  }
  if (count > 0) out.rms = std::sqrt(squares / static_cast<double>(count));
  return out;
}

}  // namespace

std::vector<Eigen::Vector3d> chain_positions(const SkeletonFit& fit, const FittedPose& pose) {
  std::vector<Eigen::Vector3d> places(fit.joints.size(), pose.root);
  std::vector<Eigen::Quaterniond> world_from_joint(fit.joints.size());
  for (std::size_t i = 0; i < fit.joints.size(); ++i) {
    const std::size_t parent = fit.joints[i].parent;
    world_from_joint[i] = i == 0 ? pose.turns[0] : world_from_joint[parent] * pose.turns[i];
    if (i > 0) places[i] = places[parent] + world_from_joint[parent] * fit.joints[i].offset;
  }
  return places;
}

std::vector<Eigen::Vector3d> rest_positions(const SkeletonFit& fit) {
  const FittedPose rest{Eigen::Vector3d::Zero(),
                        std::vector(fit.joints.size(), Eigen::Quaterniond::Identity())};
  return chain_positions(fit, rest);
}

Eigen::Vector3d end_offset(const FittedJoint& leaf) { return 0.5 * leaf.offset; }

Result<SkeletonFit> fit_skeleton(const PersonTrack& track) {
  const auto first = std::find_if(track.poses.begin(), track.poses.end(), [](const Pose& pose) {
    return pose.skeleton[JointId::SpineBase].seen();
  });
  if (first == track.poses.end())
    return fail(ErrorCode::Unsupported, "person " + std::to_string(track.person.value),
                "never shows SpineBase, on which the skeleton hangs.");
  SkeletonFit fit;
  fit.person = track.person;
  fit.joints = tree_of(track);
  const Children children = children_of(fit.joints);
  for (std::size_t i = 0; i < fit.joints.size(); ++i) {
    for (int round = 0; children[i].size() > 1 && round < kProcrustesRounds; ++round)
      average_shape(track, fit.joints, i, children[i]);
  }
  ChainFollower follower(fit.joints);
  static_cast<void>(follower.follow(first->skeleton));
  fit.poses.reserve(track.poses.size());
  for (const Pose& pose : track.poses) fit.poses.push_back(follower.follow(pose.skeleton));
  fit.residual = residual_of(fit, track);
  return fit;
}

}  // namespace chorus::exporters
