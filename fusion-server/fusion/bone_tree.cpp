#include "fusion-server/fusion/bone_tree.h"

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
    if (!seen_[p].placed || !seen_[c].placed || !(bone.sigma > 0)) return;
    const Eigen::Vector3d way = body_[c].position - body_[p].position;
    const double length = way.norm();
    if (!(length > kNoLength)) return;
    const Eigen::Vector3d u = way / length;
    const double weight = 1.0 / (bone.sigma * bone.sigma);
    const Eigen::Matrix3d stiff = weight * u * u.transpose();
    const Eigen::Vector3d push = weight * bone.length * u;
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

PlacedBody hold_bones(const PlacedBody& seen, const HeldBones& bones, int rounds) {
  Tree tree(seen);
  for (int round = 0; round < rounds; ++round) tree.step(bones);
  return tree.body();
}

}  // namespace chorus::fusion
