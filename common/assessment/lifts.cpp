#include "common/assessment/lifts.h"

#include <algorithm>
#include <cmath>

namespace chorus::assessment {
namespace {

using Eigen::Vector3d;
using enum JointId;

constexpr double kHandBeyondWrist = 0.08;  // [m]
/// An end's body may be this far from its time [s].
constexpr double kNear = 0.2;

const ergonomics::BodyAt* nearest_body(const std::vector<ergonomics::BodyAt>& bodies,
                                       Timestamp at) {
  const ergonomics::BodyAt* best = nullptr;
  double least = kNear;
  for (const ergonomics::BodyAt& body : bodies) {
    const double away = std::abs(std::chrono::duration<double>(body.at - at).count());
    if (body.carried || away > least) continue;
    least = away;
    best = &body;
  }
  return best;
}

std::optional<Vector3d> hand_of(const Skeleton<WorldSpace>& body, JointId elbow, JointId wrist) {
  if (!body[wrist].seen()) return std::nullopt;
  const Vector3d at = body[wrist].position;
  if (!body[elbow].seen()) return at;
  const Vector3d along = at - body[elbow].position;
  return along.norm() > 0.0 ? Vector3d(at + kHandBeyondWrist * along.normalized()) : at;
}

/// Where the hands hold the load: horizontal, vertical, asymmetry.
std::optional<ergonomics::Lift> end_of(const Skeleton<WorldSpace>& body) {
  const auto left = hand_of(body, ElbowLeft, WristLeft);
  const auto right = hand_of(body, ElbowRight, WristRight);
  if (!left || !right) return std::nullopt;
  for (const JointId id : {AnkleLeft, AnkleRight, HipLeft, HipRight}) {
    if (!body[id].seen()) return std::nullopt;
  }
  const Vector3d ankles = 0.5 * (body[AnkleLeft].position + body[AnkleRight].position);
  const Vector3d hands = 0.5 * (*left + *right);
  const Vector3d across = body[HipLeft].position - body[HipRight].position;
  const Vector3d forward = Vector3d(across.x(), 0.0, across.z()).cross(Vector3d::UnitY());
  const Vector3d away(hands.x() - ankles.x(), 0.0, hands.z() - ankles.z());
  ergonomics::Lift lift;
  lift.horizontal = away.norm();
  lift.vertical = std::max(0.0, hands.y());
  lift.asymmetry = std::atan2(forward.cross(away).norm(), forward.dot(away));
  return lift;
}

}  // namespace

std::optional<MeasuredLift> measured_lift(const std::vector<ergonomics::BodyAt>& bodies,
                                          const ergonomics::TaskLift& lift, Timestamp start) {
  const auto instant = [&](double at) { return start + Duration(std::llround(at * 1e9)); };
  const auto* from = nearest_body(bodies, instant(lift.span.from));
  const auto* to = nearest_body(bodies, instant(lift.span.to));
  if (from == nullptr || to == nullptr) return std::nullopt;
  const auto origin = end_of(from->body);
  const auto destination = end_of(to->body);
  if (!origin || !destination) return std::nullopt;
  MeasuredLift out{lift, *origin, *destination, {}, {}, 0.0};
  for (ergonomics::Lift* end : {&out.origin, &out.destination}) {
    end->distance = std::abs(destination->vertical - origin->vertical);
    end->per_minute = lift.per_minute;
    end->hours = lift.hours;
    end->coupling = lift.coupling;
  }
  out.origin_limit = lift_limit(out.origin);
  out.destination_limit = lift_limit(out.destination);
  out.index = std::max(ergonomics::lifting_index(lift.load_kg, out.origin_limit),
                       ergonomics::lifting_index(lift.load_kg, out.destination_limit));
  return out;
}

}  // namespace chorus::assessment
