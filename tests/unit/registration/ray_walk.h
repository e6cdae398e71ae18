// The walks of walk_builder.h as cameras without depth see them.
#pragma once

#include <algorithm>
#include <array>

#include "fusion-server/registration/ray_points.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {

inline constexpr double kRayNoise = 0.008;  // [rad] of the landmarks of a network

/// The joints of COCO that place a body: the fewer, the faster the tests.
inline bool shown_to_networks(JointId joint) {
  using enum JointId;
  constexpr std::array kShown{Head,      Neck,      SpineBase, ShoulderLeft, ShoulderRight,
                              ElbowLeft, HipLeft,   HipRight,  ElbowRight,   KneeLeft,
                              KneeRight, AnkleLeft, AnkleRight};
  return std::ranges::find(kShown, joint) != kShown.end();
}

/// Those joints as rays; `noise`: of its direction [rad].
inline WalkTrack as_rays(WalkTrack track, double noise = 0.0, unsigned seed = 1) {
  std::mt19937 random(seed * 7919 + 13);
  std::normal_distribution<double> normal;
  for (SensorFrame& frame : track.frames) {
    frame.floor.reset();
    for (BodyFrame& body : frame.bodies) {
      for (std::size_t j = 0; j < kJointCount; ++j) {
        Joint& joint = body.skeleton.joints[j];
        if (!shown_to_networks(static_cast<JointId>(j))) joint = {};
        if (!joint.seen()) continue;
        joint.position.normalize();
        for (int axis = 0; axis < 3; ++axis) joint.position[axis] += noise * normal(random);
        joint.position.normalize();
        joint.measurement = Measurement::Ray;
      }
    }
  }
  return track;
}

/// Cameras on a ring of 4 m around the walk, at different heights: place() alone has one height.
inline Eigen::Isometry3d ray_place(int number) {
  Eigen::Isometry3d place = ring_place(1.4 * number, 4.0);
  place.translation().y() += 0.25 * number;
  return place;
}

/// What `count` cameras see of a walk.
inline std::vector<WalkTrack> ray_walk(int count, const WalkSpec& spec, double noise = 0.0) {
  std::vector<WalkTrack> walk;
  WalkSpec clean = spec;
  clean.noise = 0.0;
  for (int i = 0; i < count; ++i)
    walk.push_back(
        as_rays(watch(i, ray_place(i), clean), noise, spec.seed + 100 * static_cast<unsigned>(i)));
  return walk;
}

/// The trails of a walk, as the solver takes them, and the names of its cameras.
inline std::vector<Trail> ray_trails(const std::vector<WalkTrack>& walk) {
  std::vector<Trail> trails;
  for (const WalkTrack& track : walk)
    trails.push_back(trail_of(at_nominal_distance(track), JointChoice::All));
  return trails;
}

inline std::vector<std::string> names_of(const std::vector<WalkTrack>& walk) {
  std::vector<std::string> names;
  for (const WalkTrack& track : walk) names.push_back(track.sensor.str());
  return names;
}

/// Paths that place no cameras.
inline Eigen::Vector2d on_the_spot(double t) { return {0.05 * std::sin(t), 0.05 * std::cos(t)}; }
inline Eigen::Vector2d on_one_line(double t) { return {1.4 * std::sin(0.6 * t), 0.0}; }
/// Of somebody else than wander().
inline Eigen::Vector2d another_walk(double t) {
  return {1.1 * std::cos(0.9 * t), -0.9 * std::sin(0.7 * t + 2.0)};
}

}  // namespace chorus::registration
