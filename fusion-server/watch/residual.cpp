#include "fusion-server/watch/residual.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/body/guessed_depth.h"
#include "common/geometry/rotation.h"

namespace chorus::watch {
namespace {

using Eigen::Vector3d;

/// A joint, or the midpoint of a mirror pair, and its weight.
struct Point {
  JointId first;
  JointId second;
  double weight;
};
/// The points of the trunk come first.  Limbs err more, but independently of the trunk.
constexpr std::size_t kTrunkPoints = 5;
constexpr std::array<Point, 10> kPoints{{
    {JointId::Neck, JointId::Neck, 1.0},
    {JointId::SpineShoulder, JointId::SpineShoulder, 1.0},
    {JointId::SpineMid, JointId::SpineMid, 1.0},
    {JointId::ShoulderLeft, JointId::ShoulderRight, 1.0},
    {JointId::HipLeft, JointId::HipRight, 1.0},
    {JointId::Head, JointId::Head, 1.0},
    {JointId::ElbowLeft, JointId::ElbowRight, 1.0},
    {JointId::KneeLeft, JointId::KneeRight, 1.0},
    {JointId::WristLeft, JointId::WristRight, 0.7},
    {JointId::AnkleLeft, JointId::AnkleRight, 0.7},
}};
constexpr std::size_t kEnough = 3;  // points of the trunk that two views must have in common

using Points = std::array<std::optional<Vector3d>, kPoints.size()>;

bool shown(const Joint& joint) { return joint.seen() && joint.state == JointState::Tracked; }

/// Guessed depths are wrong by decimetres for minutes, and differently for each pose.
bool measured(const Joint& joint, const SensorView& view) {
  return shown(joint) && !has_guessed_depth(joint, view.eye);
}

Points points_of(const SensorView& view) {
  Points points;
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    const Joint& first = view.skeleton[kPoints[i].first];
    const Joint& second = view.skeleton[kPoints[i].second];
    if (measured(first, view) && measured(second, view))
      points[i] = 0.5 * (first.position + second.position);
  }
  return points;
}

double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The median of each coordinate.  There must be at least one point.
Vector3d middle(const std::vector<Vector3d>& points) {
  Vector3d out;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vector3d& point : points) values.push_back(point[axis]);
    out[axis] = middle(std::move(values));
  }
  return out;
}

/// Horizontal direction in which the person faces, from all views; zero if none shows the
/// shoulders.
Vector3d front_of(const Person& person) {
  Vector3d across = Vector3d::Zero();
  for (const SensorView& view : person.views) {
    const Joint& left = view.skeleton[JointId::ShoulderLeft];
    const Joint& right = view.skeleton[JointId::ShoulderRight];
    if (shown(left) && shown(right)) across += left.position - right.position;
  }
  return across.cross(Vector3d::UnitY()).normalized();
}

/// Weighted mean of one view minus the middle of the others; none if too little of the trunk is in
/// common.
std::optional<Vector3d> apart_from(const std::vector<Points>& views, std::size_t own) {
  Vector3d sum = Vector3d::Zero();
  double weight = 0.0;
  std::size_t of_trunk = 0;
  for (std::size_t point = 0; point < kPoints.size(); ++point) {
    std::vector<Vector3d> others;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (i != own && views[i][point]) others.push_back(*views[i][point]);
    }
    if (!views[own][point] || others.empty()) continue;
    sum += kPoints[point].weight * (*views[own][point] - middle(others));
    weight += kPoints[point].weight;
    of_trunk += point < kTrunkPoints ? 1 : 0;
  }
  if (of_trunk < kEnough) return std::nullopt;
  return sum / weight;
}

/// Converts a difference in world space to the axes of Residual.
Residual seen_from(const SensorView& view, const Vector3d& place, const Vector3d& front,
                   const Vector3d& apart) {
  Vector3d way = place - view.eye;
  way.y() = 0.0;
  const Vector3d away = way.normalized();
  const Vector3d across = Vector3d::UnitY().cross(away);
  Residual out;
  out.sensor = view.sensor;
  out.apart = {apart.dot(away), apart.dot(across), apart.y()};
  out.distance = way.norm();
  out.direction = std::atan2(away.x(), away.z());
  out.front = std::atan2((-away).cross(front).y(), (-away).dot(front));
  return out;
}

bool shows_trunk(const Points& points) {
  return std::count_if(points.begin(), points.begin() + kTrunkPoints, [](const auto& point) {
           return point.has_value();
         }) >= static_cast<std::ptrdiff_t>(kEnough);
}

}  // namespace

std::optional<Vector3d> middle_of(const Person& person) {
  std::vector<Vector3d> points;
  for (const SensorView& view : person.views) {
    const Points shown = points_of(view);
    for (std::size_t i = 0; i < kTrunkPoints; ++i) {
      if (shown[i]) points.push_back(*shown[i]);
    }
  }
  if (points.empty()) return std::nullopt;
  return middle(points);
}

Person seen_clearly(const Person& person, const std::vector<Vector3d>& others) {
  constexpr double kNear = 1.0;   // [m]
  constexpr double kClose = 0.3;  // [rad]; at 3 m, about a body's width to each side
  Person out = person;
  const auto place = middle_of(person);
  if (!place) return out;
  std::erase_if(out.views, [&](const SensorView& view) {
    const Vector3d way = *place - view.eye;
    return std::any_of(others.begin(), others.end(), [&](const Vector3d& other) {
      const Vector3d there = other - view.eye;
      const double angle =
          std::abs(wrap_angle(std::atan2(way.x(), way.z()) - std::atan2(there.x(), there.z())));
      const bool before = std::hypot(there.x(), there.z()) < std::hypot(way.x(), way.z()) + kNear;
      return (other - *place).norm() < kNear || (before && angle < kClose);
    });
  });
  return out;
}

std::vector<Residual> residuals_of(const Person& person) {
  const auto place = middle_of(person);
  const Vector3d front = front_of(person);
  if (!place || front.isZero() || !front.allFinite()) return {};
  std::vector<Points> views;
  std::set<SensorId> seeing;
  for (const SensorView& view : person.views) {
    views.push_back(points_of(view));
    if (shows_trunk(views.back())) seeing.insert(view.sensor);
  }
  std::vector<Residual> out;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto apart = apart_from(views, i);
    if (!apart) continue;
    out.push_back(seen_from(person.views[i], *place, front, *apart));
    out.back().others = seeing;
    out.back().others.erase(out.back().sensor);
  }
  return out;
}

}  // namespace chorus::watch
