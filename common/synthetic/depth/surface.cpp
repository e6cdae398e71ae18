#include "common/synthetic/depth/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/units.h"
#include "common/synthetic/draw.h"

namespace chorus::synthetic::depth {
namespace {

using enum JointId;

constexpr std::uint64_t kDrawBuild = 1111;
// Distance from SpineBase to SpineShoulder of somebody 1.73 m tall [m].
constexpr double kMeanTrunk = 0.42;
constexpr double kLeastScale = 0.5;
constexpr double kMostScale = 1.5;

/// A point: base + side * (towards - base) + down * (along - base).
struct Anchor {
  JointId base;
  JointId towards;
  double side;
  JointId along;
  double down;
};

constexpr Anchor at(JointId joint) { return {joint, joint, 0, joint, 0}; }
constexpr Anchor between(JointId joint, JointId towards, double side) {
  return {joint, towards, side, joint, 0};
}

enum class Girth : std::uint8_t { Trunk, Arms, Legs };

struct Part {
  Anchor from;
  Anchor to;
  double radius_from;  ///< [mm]
  double radius_to;    ///< [mm]
  Girth girth;
  Cloth cloth;
};

// Means of ANSUR II (public data, 4082 men and 1986 women; girth / 2 pi, or depth / 2 where the
// trunk is flat): chest depth 252, waist depth 230, buttock depth 242, chest, waist and hip breadth
// 283, 318, 348; radii of neck 60, head 91, upper arm 54 (flexed), forearm 47 (flexed), wrist 27,
// thigh 99, lower thigh 65, calf 61, ankle 36 mm; hand breadth 85, foot breadth 99 mm.
constexpr std::array kParts{
    Part{{SpineShoulder, ShoulderLeft, 0.12, SpineMid, 0.35},
         {SpineMid, HipLeft, 0.2, SpineMid, 0},
         122,
         112,
         Girth::Trunk,
         Cloth::Trunk},
    Part{{SpineShoulder, ShoulderRight, 0.12, SpineMid, 0.35},
         {SpineMid, HipRight, 0.2, SpineMid, 0},
         122,
         112,
         Girth::Trunk,
         Cloth::Trunk},
    Part{{SpineMid, HipLeft, 0.2, SpineMid, 0},
         between(SpineBase, HipLeft, 0.55),
         112,
         119,
         Girth::Trunk,
         Cloth::Trunk},
    Part{{SpineMid, HipRight, 0.2, SpineMid, 0},
         between(SpineBase, HipRight, 0.55),
         112,
         119,
         Girth::Trunk,
         Cloth::Trunk},
    Part{between(SpineShoulder, ShoulderLeft, 0.4), at(ShoulderLeft), 68, 58, Girth::Trunk,
         Cloth::Trunk},
    Part{between(SpineShoulder, ShoulderRight, 0.4), at(ShoulderRight), 68, 58, Girth::Trunk,
         Cloth::Trunk},
    Part{at(SpineShoulder), between(Neck, Head, 0.3), 62, 58, Girth::Trunk, Cloth::Skin},
    Part{between(Head, Neck, 0.2), between(Head, Neck, -0.2), 86, 91, Girth::Trunk, Cloth::Hair},
    Part{at(ShoulderLeft), at(ElbowLeft), 54, 46, Girth::Arms, Cloth::Trunk},
    Part{at(ShoulderRight), at(ElbowRight), 54, 46, Girth::Arms, Cloth::Trunk},
    Part{at(ElbowLeft), at(WristLeft), 46, 29, Girth::Arms, Cloth::Skin},
    Part{at(ElbowRight), at(WristRight), 46, 29, Girth::Arms, Cloth::Skin},
    Part{at(WristLeft), at(HandLeft), 30, 38, Girth::Arms, Cloth::Skin},
    Part{at(WristRight), at(HandRight), 30, 38, Girth::Arms, Cloth::Skin},
    Part{at(HandLeft), at(HandTipLeft), 36, 18, Girth::Arms, Cloth::Skin},
    Part{at(HandRight), at(HandTipRight), 36, 18, Girth::Arms, Cloth::Skin},
    Part{at(HipLeft), at(KneeLeft), 96, 63, Girth::Legs, Cloth::Legs},
    Part{at(HipRight), at(KneeRight), 96, 63, Girth::Legs, Cloth::Legs},
    Part{at(KneeLeft), at(AnkleLeft), 62, 40, Girth::Legs, Cloth::Legs},
    Part{at(KneeRight), at(AnkleRight), 62, 40, Girth::Legs, Cloth::Legs},
    Part{at(AnkleLeft), at(FootLeft), 44, 34, Girth::Legs, Cloth::Skin},
    Part{at(AnkleRight), at(FootRight), 44, 34, Girth::Legs, Cloth::Skin},
};

Eigen::Vector3d place(const Anchor& anchor, const Skeleton<SensorSpace>& body) {
  const Eigen::Vector3d& base = body[anchor.base].position;
  return base + anchor.side * (body[anchor.towards].position - base) +
         anchor.down * (body[anchor.along].position - base);
}

double factor(const Build& build, Girth girth) {
  if (girth == Girth::Trunk) return build.trunk;
  return girth == Girth::Arms ? build.arms : build.legs;
}

double scale_of(const Skeleton<SensorSpace>& body) {
  const double trunk = (body[SpineShoulder].position - body[SpineBase].position).norm();
  return std::isfinite(trunk) ? std::clamp(trunk / kMeanTrunk, kLeastScale, kMostScale) : 1.0;
}

/// Distance to the first intersection with the ball, if that is in front of the origin.
std::optional<double> hit_ball(const Eigen::Vector3d& centre, double radius,
                               const Eigen::Vector3d& ray) {
  const double closest = ray.dot(centre);
  const double gap = radius * radius - (centre.squaredNorm() - closest * closest);
  if (gap < 0) return std::nullopt;
  const double distance = closest - std::sqrt(gap);
  return distance > 0 ? std::optional(distance) : std::nullopt;
}

/// Distance to the cone that touches both balls, between the circles of contact.
std::optional<double> hit_cone(const Taper& taper, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d axis = taper.to - taper.from;
  const double length = axis.norm();
  const double sine = length > 0 ? (taper.radius_from - taper.radius_to) / length : 1.0;
  if (std::abs(sine) >= 1.0) return std::nullopt;  // One ball contains the other.
  const Eigen::Vector3d unit = axis / length;
  // Decrease of the cone's radius per length of the axis.
  const double slope = sine / std::sqrt(1.0 - sine * sine);
  // Points x on the cone satisfy |x across the axis| = r0 - slope * along, with r0 its radius at
  // `from`.
  const double r0 = taper.radius_from / std::sqrt(1.0 - sine * sine);
  const double d = ray.dot(unit);
  const double o = -taper.from.dot(unit);
  const Eigen::Vector3d ray_across = ray - d * unit;
  const Eigen::Vector3d eye_across = -taper.from - o * unit;
  const double r_eye = r0 - slope * o;
  const double a = ray_across.squaredNorm() - slope * slope * d * d;
  const double b = ray_across.dot(eye_across) + slope * d * r_eye;
  const double c = eye_across.squaredNorm() - r_eye * r_eye;
  const double root = b * b - a * c;
  if (root < 0 || std::abs(a) < 1e-12) return std::nullopt;
  const double near = (-b - std::sqrt(root)) / a;
  const double far = (-b + std::sqrt(root)) / a;
  for (const double t : {std::min(near, far), std::max(near, far)}) {
    const double along = o + t * d;
    const bool on_it =
        along >= taper.radius_from * sine && along <= length + taper.radius_to * sine;
    if (t > 0 && on_it && r0 - slope * along >= 0) return t;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> hit(const Taper& taper, const Eigen::Vector3d& ray) {
  std::optional<double> first = hit_ball(taper.from, taper.radius_from, ray);
  for (const auto& other : {hit_ball(taper.to, taper.radius_to, ray), hit_cone(taper, ray)}) {
    if (other && (!first || *other < *first)) first = other;
  }
  return first;
}

Build draw_build(const BuildSpread& spread, std::uint64_t seed, std::size_t person) {
  Draw draw{kDrawBuild, seed, person};
  Build build;
  for (double* girth : {&build.trunk, &build.arms, &build.legs}) {
    *girth = 1.0 + draw.uniform(-spread.girth, spread.girth);
  }
  build.clothing = draw.uniform(0.0, spread.clothing);
  for (const Cloth cloth : {Cloth::Hair, Cloth::Trunk, Cloth::Legs}) {
    build.dark[static_cast<std::size_t>(cloth)] = draw.uniform() < spread.dark_chance;
  }
  return build;
}

std::vector<Taper> surface_of(const Skeleton<SensorSpace>& body, const Build& build) {
  const double scale = scale_of(body);
  std::vector<Taper> surface;
  for (const Part& part : kParts) {
    Taper taper{place(part.from, body), place(part.to, body)};
    if (!taper.from.allFinite() || !taper.to.allFinite()) continue;
    const double thickness =
        part.cloth == Cloth::Trunk || part.cloth == Cloth::Legs ? build.clothing : 0.0;
    const double times = scale * factor(build, part.girth);
    taper.radius_from = times * mm(part.radius_from) + thickness;
    taper.radius_to = times * mm(part.radius_to) + thickness;
    taper.dark = build.dark[static_cast<std::size_t>(part.cloth)];
    surface.push_back(taper);
  }
  return surface;
}

}  // namespace chorus::synthetic::depth
