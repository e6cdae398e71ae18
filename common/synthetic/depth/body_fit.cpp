#include "common/synthetic/depth/body_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/synthetic/depth/normal_equations.h"

namespace chorus::synthetic::depth {
namespace {

// Weights are relative to that of one depth point at kUsualRange.  They were chosen by hand until
// the fit followed people who walk in front of one sensor (six walks), never by a result of
// registration or fusion.

// Distance at which a depth point has weight 1 [m].
constexpr double kUsualRange = 2.5;
// Larger residuals count less [m].
constexpr double kRobust = 0.05;
constexpr double kBoneWeight = 300.0;
constexpr double kShapeWeight = 40.0;  // The trunk keeps its shape.
constexpr double kTwistWeight = 8.0;   // The hips turn with the shoulders.
constexpr double kFollowWeight = 3.0;  // A limb keeps moving as before.
constexpr double kStayWeight = 0.5;
constexpr double kRestWeight = 0.3;    // A limb without points hangs down.
constexpr double kFootWeight = 3.0;    // Toes point to the front.
constexpr double kHandWeight = 3.0;    // Hands continue the line of the forearm.
constexpr double kApartWeight = 30.0;  // Legs do not cross.
// Least distance between the knees, and between the ankles, as a share of the height.
constexpr double kApart = 0.03;
constexpr double kThroughWeight = 8.0;
// If the image shows a surface this far behind a limb's node, the node is in a wrong place [m].
constexpr double kThrough = 0.15;
// If it shows one this far behind a node of the trunk, the ray passes beside the trunk [m].
constexpr double kTrunkThrough = 0.15;
constexpr double kTrunkWeight = 8.0;
// Radius in which the nearest point of the person is looked for [m].
constexpr double kThroughReach = 0.6;
// Depth below the surface to which a node is moved [m].
constexpr double kDeep = 0.04;
// Largest step of a node in one round [m].
constexpr double kMostStep = 0.12;
constexpr double kMomentum = 0.7;
constexpr double kSupported = 0.2;
// Share of a capsule's outline that usually yields points.
constexpr double kSeen = 0.6;

struct Nearest {
  std::size_t segment = 0;
  double along = 0.0;                              ///< Position on the axis, 0..1.
  Eigen::Vector3d out = Eigen::Vector3d::UnitZ();  ///< Unit vector from the axis to the point.
  /// From the surface to the point, signed [m].
  double distance = std::numeric_limits<double>::infinity();
};

struct Axes {
  std::array<Eigen::Vector3d, kSegments.size()> from;
  std::array<Eigen::Vector3d, kSegments.size()> way;
  std::array<double, kSegments.size()> inverse;  ///< 1 / |way|^2
  std::array<double, kSegments.size()> radius;

  Axes(const Nodes& nodes, double height) {
    for (std::size_t i = 0; i < kSegments.size(); ++i) {
      from[i] = kSegments[i].from.at(nodes);
      way[i] = kSegments[i].to.at(nodes) - from[i];
      inverse[i] = 1.0 / std::max(way[i].squaredNorm(), 1e-9);
      radius[i] = kSegments[i].radius * height / kGenericHeight;
    }
  }
};

/// Finds the capsule whose surface is nearest to the point.  A sensor sees only the near side of a
/// capsule, so its axis must lie behind the point.  If it lies in front, the distance to the
/// capsule's opposite side counts.
Nearest nearest(const Axes& axes, const Eigen::Vector3d& point) {
  Nearest best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kSegments.size(); ++i) {
    const double along =
        std::clamp((point - axes.from[i]).dot(axes.way[i]) * axes.inverse[i], 0.0, 1.0);
    const Eigen::Vector3d off = point - axes.from[i] - along * axes.way[i];
    const double gap = off.norm();
    const bool is_behind = off.dot(point) <= 0;
    const double cost = is_behind ? std::abs(gap - axes.radius[i]) : gap + axes.radius[i];
    if (cost >= least) continue;
    least = cost;
    best.segment = i;
    best.along = along;
    best.out =
        is_behind && gap > 1e-6 ? Eigen::Vector3d(off / gap) : Eigen::Vector3d(-point.normalized());
    best.distance = is_behind ? gap - axes.radius[i] : off.dot(best.out) - axes.radius[i];
  }
  return best;
}

void pull_to_points(NormalEquations& equations, const Axes& axes, const Evidence& evidence) {
  for (const SurfacePoint& point : evidence.points) {
    const Nearest near = nearest(axes, point.position);
    const Segment& segment = kSegments[near.segment];
    const double range = point.position.z() / kUsualRange;
    const double weight = range * range / evidence.share * kRobust * kRobust /
                          (kRobust * kRobust + near.distance * near.distance);
    const std::array terms{Term{segment.from.first, (1 - near.along) * (1 - segment.from.share)},
                           Term{segment.from.second, (1 - near.along) * segment.from.share},
                           Term{segment.to.first, near.along * (1 - segment.to.share)},
                           Term{segment.to.second, near.along * segment.to.share}};
    equations.move_along(terms, near.out, near.distance, weight);
  }
}

void keep_length(NormalEquations& equations, const Nodes& nodes, Node a, Node b, double length) {
  const Eigen::Vector3d way = nodes.col(b) - nodes.col(a);
  const double now = way.norm();
  if (now < 1e-6) return;
  equations.move_along(std::array{Term{b, 1.0}, Term{a, -1.0}}, way / now, length - now,
                       kBoneWeight);
}

double trunk_length(const TrunkPlace& a, const TrunkPlace& b) {
  return std::hypot(a.left - b.left, a.up - b.up);
}

void keep_bones(NormalEquations& equations, const Nodes& nodes, double height) {
  for (const GenericBone& bone : kLimbs) {
    keep_length(equations, nodes, bone.parent, bone.child, height * bone.length);
  }
  for (std::size_t i = 0; i < kTrunk.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      keep_length(equations, nodes, kTrunk[j].node, kTrunk[i].node,
                  height * trunk_length(kTrunk[i], kTrunk[j]));
    }
  }
}

/// Adds the equation: sum of the combination = target.
void want(NormalEquations& equations, const Nodes& nodes, std::span<const Term> combination,
          const Eigen::Vector3d& target, double weight) {
  Eigen::Vector3d now = Eigen::Vector3d::Zero();
  for (const Term& term : combination) now += term.coefficient * nodes.col(term.node);
  equations.move(combination, target - now, weight);
}

void keep_trunk(NormalEquations& equations, const Nodes& nodes, double height) {
  const Eigen::Vector3d up = (nodes.col(kChest) - nodes.col(kPelvis)).stableNormalized();
  const auto middle = [&](Node left, Node right, Node centre, double raised) {
    want(equations, nodes, std::array{Term{left, 0.5}, Term{right, 0.5}, Term{centre, -1.0}},
         height * raised * up, kShapeWeight);
  };
  middle(kShoulderL, kShoulderR, kChest, 0.008);
  middle(kHipL, kHipR, kPelvis, -0.015);
  want(equations, nodes, std::array{Term{kHead, 1.0}, Term{kChest, -1.0}}, height * 0.13 * up,
       kShapeWeight);
  constexpr double kNarrow = 0.116 / 0.052;  // Width of the shoulders relative to that of the hips.
  want(equations, nodes,
       std::array{Term{kHipL, kNarrow}, Term{kHipR, -kNarrow}, Term{kShoulderL, -1.0},
                  Term{kShoulderR, 1.0}},
       Eigen::Vector3d::Zero(), kTwistWeight);
}

void keep_limbs(NormalEquations& equations, const FittedBody& body, const Nodes& predicted,
                const Eigen::Vector3d& up) {
  const Nodes& nodes = body.now;
  const Eigen::Vector3d left = (nodes.col(kHipL) - nodes.col(kHipR)).stableNormalized();
  const Eigen::Vector3d front = left.cross(up);
  for (const GenericBone& bone : kLimbs) {
    const std::array way{Term{bone.child, 1.0}, Term{bone.parent, -1.0}};
    const bool is_foot = bone.child == kToeL || bone.child == kToeR;
    const bool is_lost = body.support[bone.child] < kSupported;
    if (is_foot) {
      want(equations, nodes, way, body.height * bone.length * (0.85 * front - 0.53 * up),
           kFootWeight);
    }
    want(equations, nodes, way, predicted.col(bone.child) - predicted.col(bone.parent),
         kFollowWeight);
    if (is_lost && !is_foot) {
      want(equations, nodes, way, -body.height * bone.length * up, kRestWeight);
    }
  }
  for (const auto& [elbow, wrist, tip] :
       {std::array{kElbowL, kWristL, kTipL}, std::array{kElbowR, kWristR, kTipR}}) {
    constexpr double kHand = 0.108 / 0.146;
    want(equations, nodes, std::array{Term{tip, 1.0}, Term{wrist, -1 - kHand}, Term{elbow, kHand}},
         Eigen::Vector3d::Zero(), kHandWeight);
  }
  for (int node = 0; node < kNodeCount; ++node) {
    want(equations, nodes, std::array{Term{static_cast<Node>(node), 1.0}}, predicted.col(node),
         kStayWeight);
  }
}

/// Keeps the left knee and ankle to the left of the right ones.
void keep_apart(NormalEquations& equations, const Nodes& nodes, double height) {
  const Eigen::Vector3d left = (nodes.col(kHipL) - nodes.col(kHipR)).stableNormalized();
  for (const auto& [a, b] : {std::pair{kKneeL, kKneeR}, std::pair{kAnkleL, kAnkleR}}) {
    const double gap = left.dot(nodes.col(a) - nodes.col(b));
    if (gap > height * kApart) continue;
    equations.move_along(std::array{Term{a, 1.0}, Term{b, -1.0}}, left, height * kApart - gap,
                         kApartWeight);
  }
}

/// The seen point of the person that is nearest to the node; null if none is within kThroughReach.
const SurfacePoint* nearest_seen(const Evidence& evidence, const Eigen::Vector3d& node) {
  const SurfacePoint* found = nullptr;
  double least = kThroughReach * kThroughReach;
  for (const SurfacePoint& point : evidence.points) {
    const double gap = (point.position - node).squaredNorm();
    if (gap >= least) continue;
    least = gap;
    found = &point;
  }
  return found;
}

/// A node must lie behind the surface that its pixel shows.  If that surface is a little behind a
/// node of the trunk, the node is moved back along the ray (nodes of limbs are not, because limbs
/// are thinner than the error of a pixel).  If the surface is far behind a node of a limb, the node
/// is moved to the nearest point of the person.
void leave_free_space(NormalEquations& equations, const Nodes& nodes, const Evidence& evidence) {
  for (int i = 0; i < kNodeCount; ++i) {
    const Eigen::Vector3d node = nodes.col(i);
    int column = 0;
    int row = 0;
    if (!evidence.camera->see(node, column, row)) continue;
    const double past = evidence.image->at(column, row) - node.z();
    const bool is_trunk = i <= kShoulderR || i == kHipL || i == kHipR;
    if (past < (is_trunk ? 0.0 : kThrough)) continue;
    const Eigen::Vector3d ray = node.normalized();
    const std::array term{Term{static_cast<Node>(i), 1.0}};
    if (is_trunk) {
      if (past < kTrunkThrough) equations.move_along(term, ray, past + kDeep, kTrunkWeight);
    } else if (const SurfacePoint* seen = nearest_seen(evidence, node)) {
      want(equations, nodes, term, seen->position + kDeep * ray, kThroughWeight);
    }
  }
}

void limit_steps(Nodes& step) {
  for (int node = 0; node < kNodeCount; ++node) {
    const double way = step.col(node).norm();
    if (way > kMostStep) step.col(node) *= kMostStep / way;
  }
}

/// Number of points that half a capsule yields if nothing hides it.
double expected_points(const Axes& axes, std::size_t segment, const DepthCamera& camera) {
  const Eigen::Vector3d middle = axes.from[segment] + 0.5 * axes.way[segment];
  const double across = axes.way[segment].cross(middle.normalized()).norm();
  const double area = (across + axes.radius[segment]) * 2.0 * axes.radius[segment];
  const double scale = camera.focal / std::max(middle.z(), 0.3);
  return 0.5 * kSeen * area * scale * scale;
}

void measure_support(FittedBody& body, const Evidence& evidence) {
  const Axes axes(body.now, body.height);
  std::array<std::array<double, 2>, kSegments.size()> counts{};
  double sum = 0;
  for (const SurfacePoint& point : evidence.points) {
    const Nearest near = nearest(axes, point.position);
    sum += std::min(std::abs(near.distance), 4 * kRobust);
    if (std::abs(near.distance) < kRobust) {
      counts[near.segment][near.along < 0.5 ? 0 : 1] += 1.0 / evidence.share;
    }
  }
  body.misfit = evidence.points.empty() ? 0.0 : sum / static_cast<double>(evidence.points.size());
  std::array<double, kNodeCount> seen{};
  std::array<double, kNodeCount> expected{};
  for (std::size_t i = 0; i < kSegments.size(); ++i) {
    const double whole = expected_points(axes, i, *evidence.camera);
    const std::array ends{kSegments[i].from, kSegments[i].to};
    for (std::size_t end = 0; end < 2; ++end) {
      for (const Node node : {ends[end].first, ends[end].second}) {
        seen[node] += counts[i][end];
        expected[node] += whole;
      }
    }
  }
  for (std::size_t i = 0; i < kNodeCount; ++i) {
    body.support[i] = expected[i] > 0 ? seen[i] / expected[i] : 0.0;
  }
}

}  // namespace

double distance_to(const Nodes& nodes, double height, const Eigen::Vector3d& point) {
  return std::abs(nearest(Axes(nodes, height), point).distance);
}

void predict(FittedBody& body) {
  const Nodes step = kMomentum * (body.now - body.before);
  const Eigen::Vector3d trunk =
      (step.col(kPelvis) + step.col(kChest) + step.col(kHipL) + step.col(kHipR)) / 4.0;
  body.before = body.now;
  for (int node = 0; node < kNodeCount; ++node) {
    const bool is_followed = body.support[static_cast<std::size_t>(node)] >= kSupported;
    body.now.col(node) += is_followed ? Eigen::Vector3d(step.col(node)) : trunk;
  }
}

void fit(FittedBody& body, const Evidence& evidence, int rounds) {
  const Nodes predicted = body.now;
  for (int round = 0; round < rounds; ++round) {
    NormalEquations equations;
    pull_to_points(equations, Axes(body.now, body.height), evidence);
    keep_bones(equations, body.now, body.height);
    keep_trunk(equations, body.now, body.height);
    keep_limbs(equations, body, predicted, evidence.up);
    keep_apart(equations, body.now, body.height);
    leave_free_space(equations, body.now, evidence);
    Nodes step = equations.solve();
    limit_steps(step);
    body.now += step;
  }
  measure_support(body, evidence);
}

}  // namespace chorus::synthetic::depth
