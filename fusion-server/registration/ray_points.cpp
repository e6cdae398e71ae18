#include "fusion-server/registration/ray_points.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "common/base/units.h"
#include "fusion-server/registration/pairs.h"

namespace chorus::registration {
namespace {

constexpr std::size_t kFewestInstants = 160;
constexpr std::size_t kMostInstants = 640;
constexpr std::size_t kInstantsEach = 40;  // for each camera, so that no overlap is missed
// 1 - cos(2.5 deg): the least eigenvalue of two rays that cross at this angle.
constexpr double kLeastCrossing = 9.5e-4;
constexpr int kMeetings = 3;  // least squares with new distances as weights

/// Hands and feet say little: networks err most there.
bool is_used(std::size_t slot) {
  using enum JointId;
  switch (static_cast<JointId>(slot)) {
    case HandLeft:
    case HandRight:
    case HandTipLeft:
    case HandTipRight:
    case ThumbLeft:
    case ThumbRight:
      return false;
    default:
      return true;
  }
}

std::vector<Timestamp> moving_instants(const std::vector<Trail>& cameras) {
  std::vector<Timestamp> all;
  for (const Trail& trail : cameras) {
    for (const TrailFrame& frame : trail.frames) {
      if (frame.moved) all.push_back(frame.captured);
    }
  }
  std::ranges::sort(all);
  const std::size_t most =
      std::clamp(kInstantsEach * cameras.size(), kFewestInstants, kMostInstants);
  std::vector<Timestamp> chosen;
  const double step = std::max(1.0, static_cast<double>(all.size()) / static_cast<double>(most));
  for (double at = 0.0; at < static_cast<double>(all.size()); at += step)
    chosen.push_back(all[static_cast<std::size_t>(at)]);
  return chosen;
}

/// The counted rays that meet best; none if they are too nearly parallel.
std::optional<Eigen::Vector3d> nearest_to(const RayPoint& point, const RayPlaces& places) {
  std::optional<Eigen::Vector3d> x;
  for (int round = 0; round < kMeetings; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    Eigen::Matrix3d crossing = Eigen::Matrix3d::Zero();
    for (const RaySight& sight : point.seen) {
      if (!sight.counted) continue;
      const Eigen::Isometry3d& place = places.at(sight.camera);
      const Eigen::Vector3d ray = place.linear() * sight.ray;
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
      const double away = x ? (*x - place.translation()).norm() : 1.0;
      const double weight = 1.0 / std::max(1e-12, away * away * sight.sigma * sight.sigma);
      crossing += across;
      information += weight * across;
      right += weight * across * place.translation();
    }
    if (round == 0) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(crossing, Eigen::EigenvaluesOnly);
      if (!(eigen.eigenvalues()[0] >= kLeastCrossing)) return std::nullopt;
    }
    x = information.ldlt().solve(right);
    if (!x->allFinite()) return std::nullopt;
  }
  return x;
}

}  // namespace

bool sends_rays_alone(const WalkTrack& track) {
  bool saw = false;
  for (const SensorFrame& frame : track.frames) {
    for (const BodyFrame& body : frame.bodies) {
      if (!has_rays_alone(body.skeleton.joints)) return false;
      saw = true;
    }
  }
  return saw;
}

WalkTrack at_nominal_distance(WalkTrack track) {
  for (SensorFrame& frame : track.frames) {
    for (BodyFrame& body : frame.bodies) {
      for (Joint& joint : body.skeleton.joints) {
        if (joint.measurement != Measurement::Ray) continue;
        joint.measurement = Measurement::Point;
        joint.position *= kNominalDistance;
      }
    }
  }
  return track;
}

void add_sights(std::size_t camera, const TrailFrame& frame, std::vector<RayPoint>& points) {
  const auto slots = slots_of(JointChoice::All);
  for (RayPoint& point : points) {
    if (!frame.has(point.slot)) continue;
    const double away = frame.points[point.slot].norm();
    if (!(away > 0.0)) continue;
    point.seen.push_back({camera, frame.points[point.slot] / away,
                          slots[point.slot].sigma / kNominalDistance, false});
  }
}

std::vector<RayPoint> ray_points(const std::vector<Trail>& cameras, Duration max_gap) {
  std::vector<TrailReader> readers;
  for (const Trail& trail : cameras) readers.emplace_back(trail, max_gap);
  std::vector<RayPoint> points;
  const std::vector<Timestamp> instants = moving_instants(cameras);
  for (const Timestamp instant : instants) {
    std::vector<RayPoint> own;
    for (std::size_t slot = 0; slot < kJointCount; ++slot) {
      if (is_used(slot)) own.push_back({seconds(instant - instants.front()), slot, {}, {}});
    }
    for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
      if (const auto moment = readers[camera].at(instant)) add_sights(camera, moment->frame, own);
    }
    for (RayPoint& point : own) {
      if (point.seen.size() > 1) points.push_back(std::move(point));
    }
  }
  return points;
}

double ray_misfit(const RaySight& sight, const Eigen::Isometry3d& rig_from_camera,
                  const Eigen::Vector3d& x) {
  const Eigen::Vector3d ray = rig_from_camera.linear() * sight.ray;
  const Eigen::Vector3d way = x - rig_from_camera.translation();
  return std::atan2(ray.cross(way).norm(), ray.dot(way)) / sight.sigma;
}

void meet(RayPoint& point, const RayPlaces& places, double gate) {
  point.x.reset();
  std::size_t left = 0;
  for (RaySight& sight : point.seen) {
    sight.counted = places.contains(sight.camera);
    left += sight.counted ? 1 : 0;
  }
  for (; left >= 2; --left) {
    const auto x = nearest_to(point, places);
    if (!x) return;
    RaySight* worst = nullptr;
    double most = gate;
    for (RaySight& sight : point.seen) {
      if (!sight.counted) continue;
      const double off = ray_misfit(sight, places.at(sight.camera), *x);
      if (off <= most) continue;
      most = off;
      worst = &sight;
    }
    if (worst == nullptr) {
      point.x = x;
      return;
    }
    worst->counted = false;
  }
}

}  // namespace chorus::registration
