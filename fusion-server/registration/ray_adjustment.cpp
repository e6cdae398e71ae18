// The last part of ray_rig.h: all places together.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/median.h"
#include "common/geometry/rotation.h"
#include "fusion-server/registration/point_elimination.h"
#include "fusion-server/registration/ray_rig.h"
#include "fusion-server/registration/tukey.h"

namespace chorus::registration {
namespace {

constexpr double kRayGate = 4.0;     // sigmas from which a ray does not count
constexpr double kFirstGate = 12.0;  // ... at first, while the places are rough
constexpr double kLeastMisfit = 0.1;
// A ray's joint is known along it no better than this many times the error across: not at all.
constexpr double kOpenDepth = 1e3;
constexpr double kDamping = 1e-5;  // relative; also holds the factor that rays leave open
constexpr double kFixed = 1e-7;    // [rad], and of the unit: nothing moves any more

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

/// The counted rays of a point as measurements at their present distance.
PointMeasurements measured(const RayPoint& point, const RayPlaces& places,
                           const std::map<std::size_t, std::size_t>& order) {
  PointMeasurements all;
  for (const RaySight& sight : point.seen) {
    if (!sight.counted) continue;
    const double away = (*point.x - places.at(sight.camera).translation()).norm();
    PointMeasurement one;
    one.sensor = order.at(sight.camera);
    one.x = away * sight.ray;
    one.ray = sight.ray;
    one.sigma = away * sight.sigma;
    all.push_back(one);
  }
  return all;
}

/// The equations of all points; the last row, of a depth bias, which rays do not have, is held.
PlaceEquations ray_equations(const std::vector<RayPoint>& points, const RayPlaces& places,
                             double misfit) {
  std::map<std::size_t, std::size_t> order;
  std::vector<Eigen::Isometry3d> stations;
  for (const auto& [camera, place] : places) {
    order[camera] = stations.size();
    stations.push_back(place);
  }
  const auto size = static_cast<Eigen::Index>(6 * stations.size() + 1);
  PlaceEquations equations{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (const RayPoint& point : points) {
    if (!point.x) continue;
    const PointMeasurements own = measured(point, places, order);
    const FusedPoint fused = fuse_point(own, stations, kOpenDepth);
    const double off = worst_norm(fused) / (kTukey * misfit);
    const double weight = tukey_weight(off * off);
    if (weight > 0.0) add_point(equations, own, fused, weight);
  }
  return equations;
}

/// Moves the places by one step; returns the longest part of it.
double step(PlaceEquations& equations, RayPlaces& places) {
  const Eigen::Index last = equations.right.size() - 1;
  equations.information.diagonal() *= 1.0 + kDamping;
  equations.information.diagonal().array() += 1e-12 * equations.information.diagonal().maxCoeff();
  const auto hold = [&](Eigen::Index at, Eigen::Index count) {
    equations.information.middleRows(at, count).setZero();
    equations.information.middleCols(at, count).setZero();
    equations.information.block(at, at, count, count).setIdentity();
    equations.right.segment(at, count).setZero();
  };
  hold(0, 6);  // the first camera
  hold(last, 1);
  const Eigen::VectorXd motion = equations.information.ldlt().solve(equations.right);
  if (!motion.allFinite()) return 0.0;
  Eigen::Index at = 0;
  for (auto& [camera, place] : places) {
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.linear() = exp_map(Eigen::Vector3d(motion.segment<3>(at))).toRotationMatrix();
    moved.translation() = motion.segment<3>(at + 3);
    place = moved * place;
    at += 6;
  }
  return motion.lpNorm<Eigen::Infinity>();
}

}  // namespace

double adjust_rays(std::vector<RayPoint>& points, RayPlaces& places, int iterations) {
  double misfit = kFirstGate / kRayGate;
  const auto meet_all = [&] {
    for (RayPoint& point : points) meet(point, places, kRayGate * misfit);
    misfit = std::max(kLeastMisfit, misfit_of(points, places));
  };
  meet_all();
  for (int i = 0; i < iterations; ++i) {
    PlaceEquations equations = ray_equations(points, places, misfit);
    const double moved = step(equations, places);
    meet_all();
    if (moved < kFixed) break;
  }
  return misfit;
}

}  // namespace chorus::registration
