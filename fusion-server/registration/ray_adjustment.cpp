// The last part of ray_rig.h: all places and joints together, by Levenberg and Marquardt.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/median.h"
#include "common/geometry/rotation.h"
#include "fusion-server/registration/ray_rig.h"

namespace chorus::registration {
namespace {

constexpr double kRayGate = 4.0;     // sigmas from which a ray does not count
constexpr double kFirstGate = 12.0;  // ... at first, while the places are rough
constexpr double kLeastMisfit = 0.1;
constexpr double kCauchy = 2.385;  // sigmas; has 95 % efficiency for Gaussian errors
constexpr double kFalls = 1e-5;    // of the cost; with less nothing is gained any more
constexpr double kFirstDamping = 1e-3;
constexpr double kMostDamping = 1e6;
constexpr double kMoreDamping = 5.0;
constexpr double kLessDamping = 0.2;
constexpr int kMeetings = 3;  // with the rays that count chosen anew

using Row6 = Eigen::Matrix<double, 2, 6>;
using Row3 = Eigen::Matrix<double, 2, 3>;

/// A counted ray: what it is off, in its sigmas, and the derivatives of that by (turn, shift) of
/// its camera about itself and by the joint.
struct OffRay {
  Eigen::Vector2d off;
  Row6 by_camera;
  Row3 by_joint;
  double weight = 0.0;
};

Eigen::Matrix3d cross_with(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// Two unit vectors across a ray.
Row3 across(const Eigen::Vector3d& ray) {
  Row3 rows;
  rows.row(0) = ray.unitOrthogonal();
  rows.row(1) = ray.cross(Eigen::Vector3d(rows.row(0)));
  return rows;
}

/// Cauchy's loss of a squared residual, and what it weighs; `scale`: squared.
double loss(double squared, double scale) { return scale * std::log1p(squared / scale); }

OffRay off_ray(const RaySight& sight, const Eigen::Isometry3d& place, const Eigen::Vector3d& x,
               double scale) {
  const Eigen::Matrix3d turned = place.linear().transpose();
  const Eigen::Vector3d seen = turned * (x - place.translation());
  const double away = std::max(1e-9, seen.norm());
  const Eigen::Vector3d direction = seen / away;
  const Row3 rows = across(sight.ray) / sight.sigma;
  const Row3 by_seen =
      rows * (Eigen::Matrix3d::Identity() - direction * direction.transpose()) / away;
  OffRay out;
  out.off = rows * direction;
  out.by_joint = by_seen * turned;
  out.by_camera.leftCols<3>() = by_seen * cross_with(seen);
  out.by_camera.rightCols<3>() = -out.by_joint;
  out.weight = 1.0 / (1.0 + out.off.squaredNorm() / scale);
  return out;
}

/// Sum of the losses of all counted rays; a joint behind a camera costs as the worst ray.
double cost_of(const std::vector<RayPoint>& points, const RayPlaces& places, double scale) {
  double sum = 0.0;
  for (const RayPoint& point : points) {
    if (!point.x) continue;
    for (const RaySight& sight : point.seen) {
      if (!sight.counted) continue;
      const double off = ray_misfit(sight, places.at(sight.camera), *point.x);
      sum += loss(off * off, scale);
    }
  }
  return sum;
}

/// One joint's part of the normal equations.
struct JointPart {
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::vector<std::pair<Eigen::Index, Eigen::Matrix<double, 6, 3>>> shared;  ///< With cameras.
};

/// The normal equations of the places (the first is held) and of the joints.
struct RayEquations {
  Eigen::MatrixXd places;
  Eigen::VectorXd right;
  std::vector<JointPart> joints;
};

RayEquations equations_of(const std::vector<RayPoint>& points, const RayPlaces& places,
                          double scale) {
  std::map<std::size_t, Eigen::Index> row;
  for (const auto& [camera, place] : places)
    row[camera] = 6 * (static_cast<Eigen::Index>(row.size()) - 1);
  const Eigen::Index size = 6 * (static_cast<Eigen::Index>(places.size()) - 1);
  RayEquations out{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), {}};
  out.joints.reserve(points.size());
  for (const RayPoint& point : points) {
    JointPart& joint = out.joints.emplace_back();
    if (!point.x) continue;
    for (const RaySight& sight : point.seen) {
      if (!sight.counted) continue;
      const OffRay ray = off_ray(sight, places.at(sight.camera), *point.x, scale);
      joint.own += ray.weight * ray.by_joint.transpose() * ray.by_joint;
      joint.right -= ray.weight * ray.by_joint.transpose() * ray.off;
      const Eigen::Index at = row.at(sight.camera);
      if (at < 0) continue;
      out.places.block<6, 6>(at, at) += ray.weight * ray.by_camera.transpose() * ray.by_camera;
      out.right.segment<6>(at) -= ray.weight * ray.by_camera.transpose() * ray.off;
      joint.shared.emplace_back(at, ray.weight * ray.by_camera.transpose() * ray.by_joint);
    }
  }
  return out;
}

/// The equations of the places with the joints eliminated, and what is needed for these.
struct ReducedEquations {
  Eigen::MatrixXd places;
  Eigen::VectorXd right;
  std::vector<Eigen::Matrix3d> inverse;  ///< Of each joint's own part.
};

ReducedEquations reduced(const RayEquations& equations, double damping) {
  ReducedEquations out{equations.places, equations.right, {}};
  out.places.diagonal() *= 1.0 + damping;
  out.places.diagonal().array() += 1e-12 * std::max(1e-9, out.places.diagonal().maxCoeff());
  out.inverse.reserve(equations.joints.size());
  for (const JointPart& joint : equations.joints) {
    Eigen::Matrix3d own = joint.own;
    own.diagonal() *= 1.0 + damping;
    own.diagonal().array() += 1e-12 * std::max(1e-9, own.diagonal().maxCoeff());
    const Eigen::Matrix3d& inverse = out.inverse.emplace_back(own.inverse());
    for (const auto& [i, one] : joint.shared) {
      out.right.segment<6>(i) -= one * inverse * joint.right;
      for (const auto& [j, other] : joint.shared)
        out.places.block<6, 6>(i, j) -= one * inverse * other.transpose();
    }
  }
  return out;
}

/// Moves joints and places by one damped step of the equations.
void move_by(const RayEquations& equations, double damping, std::vector<RayPoint>& points,
             RayPlaces& places) {
  const ReducedEquations left = reduced(equations, damping);
  const Eigen::VectorXd motion = left.places.ldlt().solve(left.right);
  if (!motion.allFinite()) return;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k].x) continue;
    Eigen::Vector3d rest = equations.joints[k].right;
    for (const auto& [i, one] : equations.joints[k].shared)
      rest -= one.transpose() * motion.segment<6>(i);
    *points[k].x += left.inverse[k] * rest;
  }
  Eigen::Index at = -6;
  for (auto& [camera, place] : places) {
    if (at >= 0) {
      place.linear() =
          place.linear() * exp_map(Eigen::Vector3d(motion.segment<3>(at))).toRotationMatrix();
      place.translation() += motion.segment<3>(at + 3);
    }
    at += 6;
  }
}

std::vector<std::optional<Eigen::Vector3d>> joints_of(const std::vector<RayPoint>& points) {
  std::vector<std::optional<Eigen::Vector3d>> joints;
  joints.reserve(points.size());
  for (const RayPoint& point : points) joints.push_back(point.x);
  return joints;
}

/// Moves to where the rays that count now meet best; only to where the cost falls.
void descend(std::vector<RayPoint>& points, RayPlaces& places, double misfit, int iterations) {
  const double scale = kCauchy * kCauchy * misfit * misfit;
  double damping = kFirstDamping;
  double cost = cost_of(points, places, scale);
  for (int i = 0; i < iterations && damping < kMostDamping; ++i) {
    const RayEquations equations = equations_of(points, places, scale);
    const auto joints = joints_of(points);
    const RayPlaces before = places;
    double next = cost;
    for (; damping < kMostDamping; damping *= kMoreDamping) {
      move_by(equations, damping, points, places);
      next = cost_of(points, places, scale);
      if (next < cost) break;
      places = before;
      for (std::size_t k = 0; k < points.size(); ++k) points[k].x = joints[k];
    }
    if (!(cost - next > kFalls * cost)) return;
    cost = next;
    damping *= kLessDamping;
  }
}

/// The median angle of counted rays in their sigmas, as the sigma of one of the two directions.
double misfit_of(const std::vector<RayPoint>& points, const RayPlaces& places) {
  constexpr double kMedianOfTwo = 1.177;  // median of the length of two normal deviates
  std::vector<double> angles;
  for (const RayPoint& point : points) {
    if (!point.x) continue;
    for (const RaySight& sight : point.seen) {
      if (sight.counted) angles.push_back(ray_misfit(sight, places.at(sight.camera), *point.x));
    }
  }
  return angles.empty() ? 0.0 : median(std::move(angles)) / kMedianOfTwo;
}

/// Rays leave the size open: it is kept.
void keep_size(RayPlaces& places, double size) {
  const double factor = size / std::max(1e-9, size_of(places));
  const Eigen::Vector3d first = places.begin()->second.translation();
  for (auto& [camera, place] : places)
    place.translation() = first + factor * (place.translation() - first);
}

}  // namespace

double size_of(const RayPlaces& places) {
  double sum = 0.0;
  for (const auto& [camera, place] : places)
    sum += (place.translation() - places.begin()->second.translation()).norm();
  return sum;
}

double adjust_rays(std::vector<RayPoint>& points, RayPlaces& places, int iterations) {
  const double size = size_of(places);
  double misfit = kFirstGate / kRayGate;
  for (int round = 0; round < kMeetings; ++round) {
    for (RayPoint& point : points) meet(point, places, kRayGate * misfit);
    misfit = std::max(kLeastMisfit, misfit_of(points, places));
    descend(points, places, misfit, iterations);
    keep_size(places, size);
  }
  for (RayPoint& point : points) meet(point, places, kRayGate * misfit);
  return std::max(kLeastMisfit, misfit_of(points, places));
}

double rays_cost(const std::vector<RayPoint>& points, const RayPlaces& places, double misfit) {
  const double most = kRayGate * kRayGate * misfit * misfit;
  double sum = 0.0;
  double count = 0.0;
  for (const RayPoint& point : points) {
    for (const RaySight& sight : point.seen) {
      if (!places.contains(sight.camera)) continue;
      const double off =
          point.x ? ray_misfit(sight, places.at(sight.camera), *point.x) : kRayGate * misfit;
      sum += std::min(off * off, most);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace chorus::registration
