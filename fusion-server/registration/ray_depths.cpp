#include "fusion-server/registration/ray_depths.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/body/stature.h"
#include "fusion-server/registration/pairs.h"
#include "fusion-server/registration/ray_extent.h"
#include "fusion-server/registration/ray_rig.h"
#include "fusion-server/registration/ray_views.h"

namespace chorus::registration {
namespace {

constexpr double kAlong = 0.10;       // stated error along a ray, as a share of the distance
constexpr double kMostAcross = 0.03;  // ... and across at most: that depth stays a guess
constexpr double kFarRay = 4.0;       // sigmas from which a ray's joint has no depth
constexpr Duration kRayGap =
    std::chrono::milliseconds(200);  // networks find 6 to 30 people a second

/// A walk as the trails of some of its tracks.
struct RayCameras {
  std::vector<std::size_t> tracks;  ///< Indices into the walk.
  std::vector<Trail> trails;
  std::vector<std::string> names;
};

RayCameras cameras_of(const std::vector<WalkTrack>& walk, bool rays) {
  RayCameras cameras;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const bool bears = sends_rays_alone(walk[i]);
    if (bears != rays) continue;
    cameras.tracks.push_back(i);
    cameras.trails.push_back(
        trail_of(bears ? at_nominal_distance(walk[i]) : walk[i], JointChoice::All));
    cameras.names.push_back(walk[i].sensor.str());
  }
  return cameras;
}

/// The joint as a point at this distance along its ray.
void set_depth(Joint& joint, const Eigen::Vector3d& ray, double distance, double sigma) {
  const Eigen::Matrix3d along = ray * ray.transpose();
  double across = sigma;
  if (joint.covariance.known()) {
    const Eigen::Matrix3d stated = joint.covariance.matrix();
    const double variance = 0.5 * (stated.trace() - ray.dot(stated * ray));
    if (variance > 0.0 && std::isfinite(variance)) across = std::sqrt(variance);
  }
  const double error = std::min(kMostAcross, across) * distance;
  joint.measurement = Measurement::Point;
  joint.position = distance * ray;
  joint.covariance =
      Covariance(Eigen::Matrix3d(error * error * (Eigen::Matrix3d::Identity() - along) +
                                 kAlong * kAlong * distance * distance * along));
}

/// Says how far away a slot is that the camera saw in this direction; none: not known.
using DepthOf = std::function<std::optional<double>(std::size_t slot, const Eigen::Vector3d& ray)>;

/// Gives the joints of one frame their depths; those without lose their direction.
void give_depths(SensorFrame& frame, const TrailFrame& seen, const DepthOf& depth_of) {
  std::erase_if(frame.bodies, [&](const BodyFrame& body) { return body.id != seen.body; });
  if (frame.bodies.empty()) return;
  const auto slots = slots_of(JointChoice::All);
  for (std::size_t slot = 0; slot < kJointCount; ++slot) {
    Joint& joint = frame.bodies.front().skeleton.joints[slot];
    const double away = seen.points[slot].norm();
    const Eigen::Vector3d ray = seen.points[slot] / std::max(away, 1e-9);
    const auto depth = seen.has(slot) ? depth_of(slot, ray) : std::nullopt;
    if (depth) {
      set_depth(joint, ray, *depth, slots[slot].sigma / kNominalDistance);
    } else {
      joint = Joint{};
    }
  }
}

/// Every frame of a track: `at` makes the depths of one frame.
void give_depths(WalkTrack& track, const Trail& trail,
                 const std::function<DepthOf(const TrailFrame&)>& at) {
  std::size_t next = 0;
  for (SensorFrame& frame : track.frames) {
    while (next < trail.frames.size() && trail.frames[next].captured < frame.captured) ++next;
    const bool used = next < trail.frames.size() && trail.frames[next].captured == frame.captured;
    if (!used) {
      frame.bodies.clear();
      continue;
    }
    give_depths(frame, trail.frames[next], at(trail.frames[next]));
  }
  track.directions = true;
}

/// Where rays of several cameras with a place meet.
void give_met_depths(std::vector<WalkTrack>& walk, const RayCameras& cameras, const RayRig& rig) {
  const double gate = kFarRay * rig.misfit;
  for (const auto& [camera, place] : rig.places) {
    std::map<std::size_t, TrailReader> others;
    for (const auto& [other, elsewhere] : rig.places)
      if (other != camera) others.try_emplace(other, cameras.trails[other], kRayGap);
    const auto at = [&, camera = camera, place = place](const TrailFrame& frame) -> DepthOf {
      std::vector<RayPoint> points;
      for (std::size_t slot = 0; slot < kJointCount; ++slot) points.push_back({0.0, slot, {}, {}});
      add_sights(camera, frame, points);
      for (auto& [other, reader] : others) {
        if (const auto moment = reader.at(frame.captured)) add_sights(other, moment->frame, points);
      }
      return [&rig, gate, camera, place, points](
                 std::size_t slot, const Eigen::Vector3d& ray) -> std::optional<double> {
        RayPoint point = points[slot];
        meet(point, rig.places, gate);
        const bool counted = !point.seen.empty() && point.seen.front().camera == camera &&
                             point.seen.front().counted;
        if (!point.x || !counted) return std::nullopt;
        return (place.linear() * ray).dot(*point.x - place.translation());
      };
    };
    give_depths(walk[cameras.tracks[camera]], cameras.trails[camera], at);
  }
}

void scale_rig(RayRig& rig, double factor) {
  for (auto& [camera, place] : rig.places) place.translation() *= factor;
  for (RayPoint& point : rig.points) {
    if (point.x) *point.x *= factor;
  }
}

void object(std::vector<WalkTrack>& walk, const RayCameras& cameras, const std::string& reason) {
  for (const std::size_t track : cameras.tracks) walk[track].objection = reason;
}

/// A rig of nothing but rays.
void place_rig(std::vector<WalkTrack>& walk, const RayCameras& cameras,
               const RegistrationConfig& config) {
  if (cameras.tracks.size() < 2)
    return object(walk, cameras,
                  fmt::format("sensor {} sends directions without depth, which one camera alone "
                              "cannot place: add a second one, or state where it stands in "
                              "registration.file",
                              fmt::join(cameras.names, ", ")));
  auto rig = rig_of(ray_points(cameras.trails, std::max(config.max_gap, kRayGap)), cameras.names);
  if (!rig) return object(walk, cameras, rig.error().message);
  const auto unit = metres_per_unit(rig->points);
  if (!unit) return object(walk, cameras, unit.error().message);
  scale_rig(*rig, *unit);
  if (const auto wide = wide_enough(rig->points); !wide)
    return object(walk, cameras, wide.error().message);
  for (const auto& [camera, reason] : rig->refused) walk[cameras.tracks[camera]].objection = reason;
  give_met_depths(walk, cameras, *rig);
}

/// The points of another sensor at the instants of a camera's frames.
KnownPoints known_at(const Trail& camera, const Trail& other, Duration max_gap) {
  KnownPoints known;
  TrailReader reader(other, max_gap);
  for (const TrailFrame& frame : camera.frames) {
    const auto moment = reader.at(frame.captured);
    if (!moment || !frame.moved) continue;
    for (std::size_t slot = 0; slot < kJointCount; ++slot) {
      if (!frame.has(slot) || !moment->frame.has(slot)) continue;
      known.points.push_back(moment->frame.points[slot]);
      known.rays.push_back(frame.points[slot].normalized());
    }
  }
  return known;
}

/// A camera beside sensors that measure points.
void place_beside(WalkTrack& track, const Trail& trail, const RayCameras& others,
                  Duration max_gap) {
  constexpr double kAgreeing = 0.5;  // least share of the rays
  const Trail* best = nullptr;
  std::size_t most = 0;
  FoundPlace found;
  for (const Trail& other : others.trails) {
    const KnownPoints known = known_at(trail, other, max_gap);
    if (known.points.size() <= most) continue;
    const auto place = place_among(known);
    if (!place || place->agreeing < kAgreeing) continue;
    found = *place;
    most = known.points.size();
    best = &other;
  }
  if (best == nullptr) {
    track.objection = fmt::format(
        "sensor {} sends directions without depth, and fits no sensor that measures depth: walk "
        "alone where it and {} see you together",
        track.sensor.str(), fmt::join(others.names, ", "));
    return;
  }
  TrailReader reader(*best, max_gap);
  const Eigen::Isometry3d camera_from_points = found.points_from_camera.inverse();
  give_depths(track, trail, [&](const TrailFrame& frame) -> DepthOf {
    const auto moment = reader.at(frame.captured);
    return [moment, camera_from_points](std::size_t slot,
                                        const Eigen::Vector3d& ray) -> std::optional<double> {
      if (!moment || !moment->frame.has(slot)) return std::nullopt;
      const Eigen::Vector3d x = camera_from_points * moment->frame.points[slot];
      const double along = ray.dot(x);
      return along > 0.0 ? std::optional(along) : std::nullopt;
    };
  });
}

}  // namespace

std::vector<WalkTrack> with_ray_depths(std::vector<WalkTrack> walk,
                                       const RegistrationConfig& config) {
  const bool none = std::ranges::none_of(walk, sends_rays_alone);
  if (none || config.method != PairMethod::TimedRobust) return walk;
  const RayCameras cameras = cameras_of(walk, true);
  RayCameras others = cameras_of(walk, false);
  for (std::size_t i = others.trails.size(); i-- > 0;) {
    if (!others.trails[i].frames.empty()) continue;
    others.trails.erase(others.trails.begin() + static_cast<std::ptrdiff_t>(i));
    others.names.erase(others.names.begin() + static_cast<std::ptrdiff_t>(i));
  }
  if (others.trails.empty()) {
    place_rig(walk, cameras, config);
    return walk;
  }
  for (std::size_t i = 0; i < cameras.tracks.size(); ++i)
    place_beside(walk[cameras.tracks[i]], cameras.trails[i], others,
                 std::max(config.max_gap, kRayGap));
  return walk;
}

}  // namespace chorus::registration
