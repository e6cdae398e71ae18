#include "fusion-server/registration/point_elimination.h"

#include <algorithm>
#include <cmath>

#include "fusion-server/registration/adjoint.h"

namespace chorus::registration {

FusedPoint fuse_point(const PointMeasurements& measurements,
                      std::span<const Eigen::Isometry3d> world_from_level, double along_ratio,
                      double depth_bias) {
  // (I + e r r^T)^-1 = I - e / (1 + e) r r^T
  const double extra = std::max(0.0, along_ratio * along_ratio - 1.0);
  const double blunt = extra / (1.0 + extra);
  FusedPoint fused;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const PointMeasurement& measured : measurements) {
    const Eigen::Isometry3d& place = world_from_level[measured.sensor];
    const Eigen::Vector3d ray = place.linear() * measured.ray;
    fused.nearer.push_back(place.linear() * measured.nearer);
    fused.seen.push_back(place.linear() * measured.x + measured.lever * place.translation() +
                         depth_bias * fused.nearer.back());
    fused.information.push_back((Eigen::Matrix3d::Identity() - blunt * ray * ray.transpose()) /
                                (measured.sigma * measured.sigma));
    sum += fused.information.back();
    right += fused.information.back() * fused.seen.back();
  }
  fused.covariance = sum.inverse();
  fused.x = fused.covariance * right;
  return fused;
}

Eigen::Matrix<double, 3, 6> derivative_of(const PointMeasurement& measured,
                                          const Eigen::Vector3d& seen) {
  Eigen::Matrix<double, 3, 6> derivative = at_point(seen).bottomRows<3>();
  derivative.rightCols<3>() *= measured.lever;
  return derivative;
}

double worst_norm(const FusedPoint& fused) {
  double worst = 0.0;
  for (std::size_t i = 0; i < fused.seen.size(); ++i) {
    const Eigen::Vector3d off = fused.x - fused.seen[i];
    worst = std::max(worst, off.dot(fused.information[i] * off));
  }
  return std::sqrt(worst);
}

namespace {

using Rows = std::vector<Eigen::Matrix<double, 3, 6>>;

/// The last row and column.  `pulls`: S_i^-1 J_i.
void add_depth_bias(PlaceEquations& equations, const PointMeasurements& measurements,
                    const FusedPoint& fused, const Rows& pulls, double weight) {
  const Eigen::Index last = equations.right.size() - 1;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < measurements.size(); ++i)
    sum += fused.information[i] * fused.nearer[i];
  const Eigen::Vector3d common = fused.covariance * sum;  // how x moves with the bias
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * measurements[i].sensor);
    const Eigen::Vector3d pull = fused.information[i] * fused.nearer[i];
    const Eigen::Vector3d apart = fused.nearer[i] - common;
    equations.right[last] += weight * pull.dot(fused.x - fused.seen[i]);
    equations.information(last, last) += weight * pull.dot(apart);
    const Eigen::Matrix<double, 6, 1> shared = weight * pulls[i].transpose() * apart;
    equations.information.block<6, 1>(at, last) += shared;
    equations.information.block<1, 6>(last, at) += shared.transpose();
  }
}

}  // namespace

void add_point(PlaceEquations& equations, const PointMeasurements& measurements,
               const FusedPoint& fused, double weight) {
  Rows rows;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Eigen::Matrix<double, 3, 6> motion = derivative_of(measurements[i], fused.seen[i]);
    rows.push_back(fused.information[i] * motion);
    const auto at = static_cast<Eigen::Index>(6 * measurements[i].sensor);
    equations.information.block<6, 6>(at, at) += weight * motion.transpose() * rows[i];
    equations.right.segment<6>(at) += weight * rows[i].transpose() * (fused.x - fused.seen[i]);
  }
  add_depth_bias(equations, measurements, fused, rows, weight);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(6 * measurements[i].sensor);
    const Eigen::Matrix<double, 6, 3> left = weight * rows[i].transpose() * fused.covariance;
    for (std::size_t j = 0; j <= i; ++j) {  // H is symmetric
      const auto column = static_cast<Eigen::Index>(6 * measurements[j].sensor);
      const Matrix6 shared = left * rows[j];
      equations.information.block<6, 6>(row, column) -= shared;
      if (j < i) equations.information.block<6, 6>(column, row) -= shared.transpose();
    }
  }
}

}  // namespace chorus::registration
