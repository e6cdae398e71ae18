#include "common/workplace/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/rotation.h"

namespace chorus::workplace {
namespace {

using Eigen::Vector3d;
using enum JointId;

constexpr double kHeadTurns = std::numbers::pi / 6.0;
/// Of a head whose sensor states no doubt: that of nose and ears at 1.5 m.
constexpr double kUnstatedTurn = 0.1;

}  // namespace

Gaze gaze_of(const Skeleton<WorldSpace>& body, const Covariance& turn) {
  Gaze gaze;
  const Joint& head = body[Head];
  if (!head.seen()) return gaze;
  gaze.from = head.position;
  if (is_unit(head.orientation)) {
    gaze.known = true;
    gaze.direction = head.orientation.normalized() * Vector3d::UnitZ();
    gaze.sigma =
        turn.known() ? std::sqrt(std::max(0.0, turn.matrix().trace() / 3.0)) : kUnstatedTurn;
    return gaze;
  }
  const Joint& left = body[ShoulderLeft];
  const Joint& right = body[ShoulderRight];
  if (!left.seen() || !right.seen()) return gaze;
  Vector3d across = left.position - right.position;
  across.y() = 0.0;
  if (!(across.norm() > 0.0)) return gaze;
  gaze.known = true;
  gaze.assumed = true;
  gaze.direction = across.normalized().cross(Vector3d::UnitY());
  gaze.sigma = kHeadTurns;
  return gaze;
}

Seen sight_of(const Gaze& gaze, const Vector3d& point, const Scene& scene) {
  Seen seen;
  const Vector3d way = point - gaze.from;
  if (!gaze.known || !way.allFinite() || !(way.norm() > 0.0)) return seen;
  seen.angle = std::atan2(gaze.direction.cross(way).norm(), gaze.direction.dot(way));
  const double margin = scene.view - seen.angle;
  seen.probability = gaze.sigma > 0.0 ? 0.5 * std::erfc(-margin / gaze.sigma / std::numbers::sqrt2)
                                      : (margin >= 0.0 ? 1.0 : 0.0);
  seen.hidden_by = obstacle_between(scene, gaze.from, point);
  return seen;
}

}  // namespace chorus::workplace
