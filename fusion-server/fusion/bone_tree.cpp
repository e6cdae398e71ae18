#include "fusion-server/fusion/bone_tree.h"

#include <algorithm>

#include <Eigen/LU>

namespace chorus::fusion {
namespace {

constexpr double kNoLength = 1e-3;  // [m] a shorter bone has no direction

/// A joint's part of the normal equations; it is kept after its elimination, for back-substitution.
struct Node {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

/// x_child = offset + follow x_parent.
struct Follower {
  bool held = false;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();  ///< Covariance of the child, given its parent.
  Eigen::Matrix3d follow = Eigen::Matrix3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

/// What a bone adds to the normal equations of its ends.
struct Spring {
  Eigen::Matrix3d stiff;
  Eigen::Vector3d push;
};

/// `way`: from parent to child now.  Nothing if the bone holds nothing.
std::optional<Spring> spring_of(const HeldBone& bone, const Eigen::Vector3d& way) {
  if (bone.way) {
    const Eigen::Matrix3d stiff = bone.way->covariance.inverse();
    return Spring{stiff, stiff * bone.way->way};
  }
  const double length = way.norm();
  if (!(bone.sigma > 0) || !(length > kNoLength)) return std::nullopt;
  const Eigen::Vector3d u = way / length;
  const double weight = 1.0 / (bone.sigma * bone.sigma);
  return Spring{weight * u * u.transpose(), weight * bone.length * u};
}

class Tree {
 public:
  explicit Tree(const PlacedBody& seen) : seen_(seen), body_(seen) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      information_[j].setZero();
      if (seen[j].placed) information_[j] = seen[j].covariance.inverse();
    }
  }

  void step(const HeldBones& bones) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      nodes_[j] = {information_[j], information_[j] * seen_[j].position};
    }
    follows_.fill(false);
    for (std::size_t b = kBones.size(); b-- > 0;) eliminate(b, bones[b]);
    place_roots();
    for (std::size_t b = 0; b < kBones.size(); ++b) place_child(b);
  }

  [[nodiscard]] const PlacedBody& body() const { return body_; }

 private:
  /// Eqs. (5), (6): eliminates the child; its information about its parent stays.
  void eliminate(std::size_t b, const HeldBone& bone) {
    followers_[b] = {};
    const std::size_t p = index_of(kBones[b].parent);
    const std::size_t c = index_of(kBones[b].child);
    if (!seen_[p].placed || !seen_[c].placed) return;
    const auto spring = spring_of(bone, body_[c].position - body_[p].position);
    if (!spring) return;
    const auto& [stiff, push] = *spring;
    const Eigen::Matrix3d spread = (nodes_[c].information + stiff).inverse();
    Follower& follower = followers_[b];
    follower = {true, spread, spread * stiff, spread * (nodes_[c].right + push)};
    follows_[c] = true;
    nodes_[p].information += stiff - stiff * spread * stiff;
    nodes_[p].right += stiff * follower.offset - push;
  }

  void place_roots() {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!seen_[j].placed || follows_[j]) continue;
      body_[j].covariance = nodes_[j].information.inverse();
      body_[j].position = body_[j].covariance * nodes_[j].right;
    }
  }

  /// Eq. (7): places a child; parents are placed before their children.
  void place_child(std::size_t b) {
    const Follower& follower = followers_[b];
    if (!follower.held) return;
    const PlacedJoint& parent = body_[index_of(kBones[b].parent)];
    PlacedJoint& child = body_[index_of(kBones[b].child)];
    child.position = follower.offset + follower.follow * parent.position;
    child.covariance =
        follower.spread + follower.follow * parent.covariance * follower.follow.transpose();
  }

  const PlacedBody& seen_;
  PlacedBody body_;
  std::array<Eigen::Matrix3d, kJointCount> information_;
  std::array<Node, kJointCount> nodes_;
  std::array<Follower, kBones.size()> followers_;
  std::array<bool, kJointCount> follows_{};  ///< Placed after its parent, by its follower.
};

}  // namespace

HeldWay held_way(const HeldBone& bone, const Eigen::Vector3d& direction,
                 const Eigen::Matrix3d& covariance) {
  const double along = std::max(bone.sigma, kNoLength);
  // Across the direction at least so much, so that the way's covariance has an inverse.
  const Eigen::Matrix3d across =
      bone.length * bone.length * covariance + kNoLength * kNoLength * Eigen::Matrix3d::Identity();
  return {bone.length * direction, across + along * along * direction * direction.transpose()};
}

PlacedBody hold_bones(const PlacedBody& seen, const HeldBones& bones, int rounds) {
  Tree tree(seen);
  for (int round = 0; round < rounds; ++round) tree.step(bones);
  return tree.body();
}

}  // namespace chorus::fusion
