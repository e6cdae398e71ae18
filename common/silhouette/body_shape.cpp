#include "common/silhouette/body_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/sensor/pixel_ray.h"

namespace chorus::silhouette {
namespace {

using enum JointId;

/// Radii of a person of 1.75 m [m]: half the mean of breadth and depth of each part (ANSUR II,
/// means of men and women, rounded).  The trunk is two columns side by side, because it is twice
/// as broad as deep.
constexpr double kShapedFor = 1.75;
constexpr std::array kUsual{
    ShapedBone{SpineShoulder, Head, 0.055, 0.090},
    ShapedBone{Head, Head, 0.105, 0.105},
    ShapedBone{ShoulderLeft, HipLeft, 0.070, 0.105},
    ShapedBone{ShoulderRight, HipRight, 0.070, 0.105},
    ShapedBone{SpineShoulder, SpineMid, 0.095, 0.110},
    ShapedBone{SpineMid, SpineBase, 0.110, 0.115},
    ShapedBone{ShoulderLeft, ElbowLeft, 0.055, 0.043},
    ShapedBone{ShoulderRight, ElbowRight, 0.055, 0.043},
    ShapedBone{ElbowLeft, WristLeft, 0.043, 0.030},
    ShapedBone{ElbowRight, WristRight, 0.043, 0.030},
    ShapedBone{WristLeft, HandTipLeft, 0.032, 0.020},
    ShapedBone{WristRight, HandTipRight, 0.032, 0.020},
    ShapedBone{HipLeft, KneeLeft, 0.090, 0.060},
    ShapedBone{HipRight, KneeRight, 0.090, 0.060},
    ShapedBone{KneeLeft, AnkleLeft, 0.058, 0.040},
    ShapedBone{KneeRight, AnkleRight, 0.058, 0.040},
    ShapedBone{AnkleLeft, FootLeft, 0.045, 0.030},
    ShapedBone{AnkleRight, FootRight, 0.045, 0.030},
};

constexpr double kNearest = 0.2;  // Nearer spheres are left out [m].
/// Of one side of a capsule: a bone near the lens's plane is thousands of pictures long.
constexpr long kMostPoints = 1000;

/// The two tangents of two circles: unit normals, outwards.  Without tangents one circle lies
/// within the other.
struct Tangents {
  Eigen::Vector2d left;
  Eigen::Vector2d right;
  bool any = false;
};

Tangents tangents_of(const FlatCapsule& capsule) {
  const Eigen::Vector2d along = capsule.b - capsule.a;
  const double length = along.norm();
  Tangents out;
  const double sine = length > 0.0 ? (capsule.a_radius - capsule.b_radius) / length : 2.0;
  if (!(std::abs(sine) < 1.0)) return out;
  const Eigen::Vector2d u = along / length;
  const Eigen::Vector2d side(-u.y(), u.x());
  const double cosine = std::sqrt(1.0 - sine * sine);
  out.left = sine * u + cosine * side;
  out.right = sine * u - cosine * side;
  out.any = true;
  return out;
}

using Points = std::vector<OutlinePoint>;

long points_on(double length, double spacing) {
  const double points = length / spacing;
  return points < static_cast<double>(kMostPoints) ? std::max(1L, std::lround(points))
                                                   : kMostPoints;
}

void add_line(const FlatCapsule& capsule, const Eigen::Vector2d& normal, double spacing,
              Points& out) {
  const Eigen::Vector2d from = capsule.a + capsule.a_radius * normal;
  const Eigen::Vector2d to = capsule.b + capsule.b_radius * normal;
  const long count = points_on((to - from).norm(), spacing);
  for (long i = 0; i < count; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    out.push_back({(1.0 - share) * from + share * to, normal,
                   (1.0 - share) * capsule.a_depth + share * capsule.b_depth});
  }
}

struct Arc {
  Eigen::Vector2d centre;
  double radius;
  double depth;
  double from;  ///< Angle [rad].
  double sweep;
};

void add_arc(const Arc& arc, double spacing, Points& out) {
  const long count = points_on(std::abs(arc.sweep) * arc.radius, spacing);
  for (long i = 0; i < count; ++i) {
    const double angle =
        arc.from + arc.sweep * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    out.push_back({arc.centre + arc.radius * normal, normal, arc.depth});
  }
}

double angle_of(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

double positive(double angle) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle < 0.0 ? angle + kTurn : angle;
}

void add_capsule(const FlatCapsule& capsule, double spacing, Points& out) {
  const Tangents tangents = tangents_of(capsule);
  constexpr double kTurn = 2.0 * std::numbers::pi;
  if (!tangents.any) {
    const bool a = capsule.a_radius >= capsule.b_radius;
    add_arc({a ? capsule.a : capsule.b, a ? capsule.a_radius : capsule.b_radius,
             a ? capsule.a_depth : capsule.b_depth, 0.0, kTurn},
            spacing, out);
    return;
  }
  add_line(capsule, tangents.left, spacing, out);
  add_line(capsule, tangents.right, spacing, out);
  const double left = angle_of(tangents.left);
  const double right = angle_of(tangents.right);
  add_arc({capsule.a, capsule.a_radius, capsule.a_depth, left, positive(right - left)}, spacing,
          out);
  add_arc({capsule.b, capsule.b_radius, capsule.b_depth, right, positive(left - right)}, spacing,
          out);
}

}  // namespace

std::vector<ShapedBone> usual_shape(double stature, double girth) {
  std::vector<ShapedBone> out(kUsual.begin(), kUsual.end());
  const double factor = girth * stature / kShapedFor;
  for (ShapedBone& bone : out) {
    bone.from_radius *= factor;
    bone.to_radius *= factor;
  }
  return out;
}

std::vector<FlatCapsule> flat_capsules(const Skeleton<WorldSpace>& body,
                                       std::span<const ShapedBone> shape,
                                       const Eigen::Isometry3d& world_from_sensor,
                                       const Intrinsics& camera) {
  const Eigen::Isometry3d camera_from_world =
      Eigen::Isometry3d(camera_from_sensor_axes()) * world_from_sensor.inverse();
  std::vector<FlatCapsule> out;
  for (const ShapedBone& bone : shape) {
    if (!body[bone.from].seen() || !body[bone.to].seen()) continue;
    const Eigen::Vector3d a = camera_from_world * body[bone.from].position;
    const Eigen::Vector3d b = camera_from_world * body[bone.to].position;
    const auto a_pixel = pixel_of(a, camera);
    const auto b_pixel = pixel_of(b, camera);
    if (!a_pixel || !b_pixel || a.z() < kNearest || b.z() < kNearest) continue;
    out.push_back({*a_pixel, *b_pixel, pixels_per_metre(a, camera) * bone.from_radius,
                   pixels_per_metre(b, camera) * bone.to_radius, a.z(), b.z()});
  }
  return out;
}

Eigen::AlignedBox2d box_of(std::span<const FlatCapsule> capsules) {
  Eigen::AlignedBox2d out;
  for (const FlatCapsule& capsule : capsules) {
    const Eigen::Vector2d a(capsule.a_radius, capsule.a_radius);
    const Eigen::Vector2d b(capsule.b_radius, capsule.b_radius);
    out.extend(capsule.a - a).extend(capsule.a + a).extend(capsule.b - b).extend(capsule.b + b);
  }
  return out;
}

double distance(const FlatCapsule& capsule, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d along = capsule.b - capsule.a;
  const double length = along.norm();
  const double sine = length > 0.0 ? (capsule.a_radius - capsule.b_radius) / length : 2.0;
  const double to_a = (pixel - capsule.a).norm() - capsule.a_radius;
  const double to_b = (pixel - capsule.b).norm() - capsule.b_radius;
  if (!(std::abs(sine) < 1.0)) return std::min(to_a, to_b);
  const Eigen::Vector2d u = along / length;
  const Eigen::Vector2d from_a = pixel - capsule.a;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double forward = from_a.dot(u);
  const double side = std::abs(from_a.x() * u.y() - from_a.y() * u.x());
  // Where the tangent is nearest: measured along the bone, shifted by the slope of the tangent.
  const double foot = forward - side * sine / cosine;
  if (foot <= 0.0) return to_a;
  if (foot >= length) return to_b;
  return forward * sine + side * cosine - capsule.a_radius;
}

std::vector<OutlinePoint> outline_of(std::span<const FlatCapsule> capsules, double spacing) {
  Points all;
  std::vector<std::size_t> owner;
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    add_capsule(capsules[i], spacing, all);
    owner.resize(all.size(), i);
  }
  Points out;
  constexpr double kInside = -0.5;  // A point on two outlines is on both [px].
  for (std::size_t p = 0; p < all.size(); ++p) {
    const bool inside = std::any_of(capsules.begin(), capsules.end(), [&](const FlatCapsule& c) {
      return static_cast<std::size_t>(&c - capsules.data()) != owner[p] &&
             distance(c, all[p].pixel) < kInside;
    });
    if (!inside) out.push_back(all[p]);
  }
  return out;
}

}  // namespace chorus::silhouette
