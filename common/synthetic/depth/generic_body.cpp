#include "common/synthetic/depth/generic_body.h"

namespace chorus::synthetic::depth {
namespace {

using enum JointId;

/// The place of a joint on the body (joints_of() then moves the thumbs).
struct Source {
  JointId joint;
  Between place;
};

// clang-format off
constexpr std::array kSources{
    Source{SpineBase, on(kPelvis)},
    Source{SpineMid, {kPelvis, kChest, 0.45}},
    Source{SpineShoulder, on(kChest)},
    Source{Neck, {kChest, kHead, 0.37}},
    Source{Head, on(kHead)},
    Source{ShoulderLeft, on(kShoulderL)}, Source{ShoulderRight, on(kShoulderR)},
    Source{ElbowLeft, on(kElbowL)},       Source{ElbowRight, on(kElbowR)},
    Source{WristLeft, on(kWristL)},       Source{WristRight, on(kWristR)},
    Source{HandLeft, {kWristL, kTipL, 0.45}},      Source{HandRight, {kWristR, kTipR, 0.45}},
    Source{HandTipLeft, on(kTipL)},                Source{HandTipRight, on(kTipR)},
    Source{ThumbLeft, {kWristL, kTipL, 0.5}},      Source{ThumbRight, {kWristR, kTipR, 0.5}},
    Source{HipLeft, on(kHipL)},           Source{HipRight, on(kHipR)},
    Source{KneeLeft, on(kKneeL)},         Source{KneeRight, on(kKneeR)},
    Source{AnkleLeft, on(kAnkleL)},       Source{AnkleRight, on(kAnkleR)},
    Source{FootLeft, on(kToeL)},          Source{FootRight, on(kToeR)},
};
// clang-format on

// Distance of the thumb from the hand, towards the pelvis, as a share of the height.
constexpr double kThumb = 0.022;

}  // namespace

Nodes standing(const Stance& stance) {
  Nodes nodes = Nodes::Zero();
  const Eigen::Vector3d front = stance.left.cross(stance.up);
  for (const TrunkPlace& place : kTrunk) {
    nodes.col(place.node) =
        stance.foot + stance.height * (place.left * stance.left + place.up * stance.up);
  }
  for (const GenericBone& bone : kLimbs) {
    const bool is_foot = bone.child == kToeL || bone.child == kToeR;
    const Eigen::Vector3d along =
        is_foot ? Eigen::Vector3d(0.85 * front - 0.53 * stance.up) : Eigen::Vector3d(-stance.up);
    nodes.col(bone.child) = nodes.col(bone.parent) + stance.height * bone.length * along;
  }
  return nodes;
}

Node other_side(Node node) {
  if (node <= kHead) return node;
  return static_cast<Node>(node % 2 == 1 ? node + 1 : node - 1);  // left nodes are odd
}

Nodes exchanged(const Nodes& nodes) {
  Nodes out;
  for (int i = 0; i < kNodeCount; ++i) out.col(i) = nodes.col(other_side(static_cast<Node>(i)));
  return out;
}

Skeleton<SensorSpace> joints_of(const Nodes& nodes, double height) {
  Skeleton<SensorSpace> body;
  for (const Source& source : kSources) {
    body[source.joint].position = source.place.at(nodes);
    body[source.joint].state = JointState::Tracked;
  }
  for (const auto& [thumb, hand] :
       {std::pair{ThumbLeft, HandLeft}, std::pair{ThumbRight, HandRight}}) {
    const Eigen::Vector3d inwards = nodes.col(kPelvis) - body[hand].position;
    body[thumb].position += height * kThumb * inwards.stableNormalized();
  }
  return body;
}

Node node_of(JointId joint) {
  for (const Source& source : kSources) {
    if (source.joint == joint) {
      return source.place.share > 0.3 ? source.place.second : source.place.first;
    }
  }
  return kPelvis;
}

}  // namespace chorus::synthetic::depth
