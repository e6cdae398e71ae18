// The body that is fitted to everybody: nineteen nodes, bones of average proportions, and capsules
// around them.
//
// It has neither the build nor the bone lengths of the person it is fitted to.  Bone lengths are
// shares of the body height (Drillis and Contini, as given by Winter), girths are means (ANSUR II).
// Only the feet tell front from rear.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "common/base/units.h"
#include "common/body/skeleton.h"

namespace chorus::synthetic::depth {

// clang-format off
enum Node : std::uint8_t {
  kPelvis, kChest, kHead,
  kShoulderL, kShoulderR, kElbowL, kElbowR, kWristL, kWristR, kTipL, kTipR,
  kHipL, kHipR, kKneeL, kKneeR, kAnkleL, kAnkleR, kToeL, kToeR,
};
// clang-format on
inline constexpr int kNodeCount = 19;

/// One column per node [m].
using Nodes = Eigen::Matrix<double, 3, kNodeCount>;

/// A point on the line through two nodes.
struct Between {
  Node first;
  Node second;
  double share = 0.0;  ///< 0: at the first, 1: at the second.

  [[nodiscard]] Eigen::Vector3d at(const Nodes& nodes) const {
    return (1.0 - share) * nodes.col(first) + share * nodes.col(second);
  }
};

struct Segment {
  Between from;
  Between to;
  double radius;  ///< Radius for a body of kGenericHeight [m].
};

constexpr Between on(Node node) { return {node, node, 0.0}; }

inline constexpr double kGenericHeight = 1.7;  ///< The height that the radii below are for [m]

// clang-format off
inline constexpr std::array kSegments{
    Segment{{kChest, kShoulderL, 0.25}, {kPelvis, kHipL, 0.5}, mm(115)},
    Segment{{kChest, kShoulderR, 0.25}, {kPelvis, kHipR, 0.5}, mm(115)},
    Segment{{kChest, kShoulderL, 0.5}, on(kShoulderL), mm(60)},
    Segment{{kChest, kShoulderR, 0.5}, on(kShoulderR), mm(60)},
    Segment{on(kChest), on(kHead), mm(58)},
    Segment{{kHead, kChest, 0.1}, {kHead, kChest, -0.1}, mm(90)},
    Segment{on(kShoulderL), on(kElbowL), mm(50)},
    Segment{on(kShoulderR), on(kElbowR), mm(50)},
    Segment{on(kElbowL), on(kWristL), mm(38)},
    Segment{on(kElbowR), on(kWristR), mm(38)},
    Segment{on(kWristL), on(kTipL), mm(30)},
    Segment{on(kWristR), on(kTipR), mm(30)},
    Segment{on(kHipL), on(kKneeL), mm(78)},
    Segment{on(kHipR), on(kKneeR), mm(78)},
    Segment{on(kKneeL), on(kAnkleL), mm(50)},
    Segment{on(kKneeR), on(kAnkleR), mm(50)},
    Segment{on(kAnkleL), on(kToeL), mm(38)},
    Segment{on(kAnkleR), on(kToeR), mm(38)},
};

/// A bone and its length as a share of body height.
struct GenericBone {
  Node parent;
  Node child;
  double length;
};
/// Limbs: parents before children.
inline constexpr std::array kLimbs{
    GenericBone{kShoulderL, kElbowL, 0.186}, GenericBone{kShoulderR, kElbowR, 0.186},
    GenericBone{kElbowL, kWristL, 0.146},    GenericBone{kElbowR, kWristR, 0.146},
    GenericBone{kWristL, kTipL, 0.108},      GenericBone{kWristR, kTipR, 0.108},
    GenericBone{kHipL, kKneeL, 0.245},       GenericBone{kHipR, kKneeR, 0.245},
    GenericBone{kKneeL, kAnkleL, 0.246},     GenericBone{kKneeR, kAnkleR, 0.246},
    GenericBone{kAnkleL, kToeL, 0.085},      GenericBone{kAnkleR, kToeR, 0.085},
};
// clang-format on

/// Where the nodes of the trunk are in a standing body, as shares of its height: towards the body's
/// left, and up from the floor.
struct TrunkPlace {
  Node node;
  double left;
  double up;
};
inline constexpr std::array kTrunk{
    TrunkPlace{kPelvis, 0, 0.545},         TrunkPlace{kChest, 0, 0.800},
    TrunkPlace{kHead, 0, 0.930},           TrunkPlace{kShoulderL, 0.116, 0.808},
    TrunkPlace{kShoulderR, -0.116, 0.808}, TrunkPlace{kHipL, 0.052, 0.530},
    TrunkPlace{kHipR, -0.052, 0.530},
};

/// Where and how a body stands, in sensor space.
struct Stance {
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();  ///< On the floor under the pelvis.
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  Eigen::Vector3d left = -Eigen::Vector3d::UnitX();  ///< To the body's left.
  double height = kGenericHeight;                    ///< [m]
};

/// A body that stands upright, with hanging arms and its feet pointing forwards.
[[nodiscard]] Nodes standing(const Stance& stance);

/// The corresponding node on the other side of the body.
[[nodiscard]] Node other_side(Node node);

/// The nodes with left and right swapped.
[[nodiscard]] Nodes exchanged(const Nodes& nodes);

/// The 25 joints of Kinect v2, all tracked; orientations are not given.
[[nodiscard]] Skeleton<SensorSpace> joints_of(const Nodes& nodes, double height);

/// The node whose support determines whether the joint is tracked or inferred.
[[nodiscard]] Node node_of(JointId joint);

}  // namespace chorus::synthetic::depth
