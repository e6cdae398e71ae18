#include "fusion-server/fusion/limb_ends.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace chorus::fusion {
namespace {

using enum JointId;

constexpr double kUsualTime = 10.0;        // [s] over which the usual way is learned
constexpr double kAlikeErrors = 0.5;       // [s] within which errors are the same
constexpr double kShortestStep = 5e-3;     // [s] the least time that an instant counts for
constexpr double kLongestStep = 0.1;       // [s] the most time that an instant counts for
constexpr double kUnusual = 2.0;           // [standard deviations] from the usual way
constexpr double kLeastClear = 1e-3;       // of a limb that points along the hips or shoulders
constexpr double kClearSquareSine = 0.67;  // square of the sine from which its roll is clear

/// A foot or a part of a hand, and what gives the axes of its limb.
struct LimbEnd {
  JointId end;
  JointId at;    ///< Ankle or wrist.
  JointId from;  ///< The other end of the limb.
  JointId left;  ///< Of hips or shoulders; its mirror is the right one.
};

constexpr std::array kLeftEnds{LimbEnd{FootLeft, AnkleLeft, KneeLeft, HipLeft},
                               LimbEnd{HandLeft, WristLeft, ElbowLeft, ShoulderLeft},
                               LimbEnd{HandTipLeft, WristLeft, ElbowLeft, ShoulderLeft},
                               LimbEnd{ThumbLeft, WristLeft, ElbowLeft, ShoulderLeft}};

/// The axes of a limb in the world.
struct LimbAxes {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// 1: the roll of the limb is known; near 0: it points along the hips or shoulders.
  double clear = 0.0;
};

std::optional<LimbAxes> axes_of(const LimbEnd& limb, const PlacedBody& body) {
  const auto placed = [&](JointId id) { return body[index_of(id)].placed; };
  const auto at = [&](JointId id) { return body[index_of(id)].position; };
  if (!placed(limb.at) || !placed(limb.from) || !placed(limb.left) || !placed(mirror(limb.left))) {
    return std::nullopt;
  }
  const Eigen::Vector3d along = (at(limb.from) - at(limb.at)).normalized();
  const Eigen::Vector3d across = (at(limb.left) - at(mirror(limb.left))).normalized();
  const Eigen::Vector3d ahead = along.cross(across);
  const double square_sine = ahead.squaredNorm();
  if (!(square_sine > kLeastClear)) return std::nullopt;
  LimbAxes found{{}, std::min(1.0, square_sine / kClearSquareSine)};
  found.axes << along, ahead.cross(along).normalized(), ahead.normalized();
  return found;
}

/// Visits all limb ends whose own and whose limb's variance are stated.
template <class Visit>
void each_end(const StatedVariances& stated, const Visit& visit) {
  for (const LimbEnd& left : kLeftEnds) {
    const LimbEnd right{mirror(left.end), mirror(left.at), mirror(left.from), left.left};
    for (const LimbEnd& limb : {left, right}) {
      if (stated[index_of(limb.end)] > 0 && stated[index_of(limb.at)] > 0) visit(limb);
    }
  }
}

}  // namespace

void LimbEnds::learn(const PlacedBody& seen, const StatedVariances& stated, double passed,
                     const BodyModel& model) {
  if (!(model.limb_end > 0)) return;
  const double time = std::clamp(passed, kShortestStep, kLongestStep);
  each_end(stated, [&](const LimbEnd& limb) {
    const auto axes = axes_of(limb, seen);
    if (!axes) return;
    const std::size_t end = index_of(limb.end);
    const double variance = stated[end] + stated[index_of(limb.at)];
    Usual& usual = usual_[end];
    const double weight = axes->clear * time / variance;
    usual.weight = std::exp(-time / kUsualTime) * usual.weight + weight;
    const double share = weight / usual.weight;
    const Eigen::Vector3d way =
        axes->axes.transpose() * (seen[end].position - seen[index_of(limb.at)].position);
    const Eigen::Vector3d off = way - usual.way;
    usual.way += share * off;
    usual.scatter += share * ((1.0 - share) * off.squaredNorm() / 3.0 - usual.scatter);
  });
}

PlacedBody LimbEnds::held(PlacedBody body, const StatedVariances& stated, const BodyModel& model) {
  left_.fill(1.0);
  if (!(model.limb_end > 0)) return body;
  each_end(stated, [&](const LimbEnd& limb) {
    const std::size_t end = index_of(limb.end);
    const std::size_t at = index_of(limb.at);
    const Usual& usual = usual_[end];
    const auto axes = axes_of(limb, body);
    if (!axes || !body[end].placed || !(usual.weight > 0)) return;
    const double views = stated[end] + stated[at];
    const double bends = model.limb_end * usual.way.norm();
    const double variance = std::max(bends * bends, usual.scatter - views) / axes->clear +
                            stated[at] + kAlikeErrors / usual.weight;
    const Eigen::Vector3d off = body[at].position + axes->axes * usual.way - body[end].position;
    const double distance = off.norm() / std::sqrt(stated[end] + variance);
    const double believed = distance > kUnusual ? kUnusual / distance : 1.0;
    const double share = believed * stated[end] / (stated[end] + variance);
    body[end].position += share * off;
    body[end].covariance *= 1.0 - share;
    // Errors that do not change are in the usual way, too: of somebody who stands still it tells
    // nothing new.
    left_[end] = 1.0 - std::min(1.0, usual.scatter / views) * share;
  });
  return body;
}

}  // namespace chorus::fusion
