#include "common/geometry/rigid_fit.h"

#include <cmath>

#include <Eigen/SVD>

#include "common/geometry/rotation.h"

namespace chorus {
namespace {

struct Centred {
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  double weight = 0.0;
  /// sum w (target)(source)^T about the centroids
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
};

double weight_at(std::span<const double> weights, std::size_t i) {
  return weights.empty() ? 1.0 : weights[i];
}

Result<Centred> centre(std::span<const Eigen::Vector3d> source,
                       std::span<const Eigen::Vector3d> target, std::span<const double> weights) {
  if (source.size() != target.size() || (!weights.empty() && weights.size() != source.size())) {
    return fail(ErrorCode::InvalidArgument, "rigid fit", "needs equally many points on each side");
  }
  Centred sum;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double w = weight_at(weights, i);
    if (!(w >= 0)) {
      return fail(ErrorCode::InvalidArgument, "rigid fit",
                  "weights must be finite and not negative");
    }
    sum.source += w * source[i];
    sum.target += w * target[i];
    sum.weight += w;
  }
  if (!(sum.weight > 0) || !sum.source.allFinite() || !sum.target.allFinite()) {
    return fail(ErrorCode::InvalidArgument, "rigid fit",
                "needs finite points and a positive total weight");
  }
  sum.source /= sum.weight;
  sum.target /= sum.weight;
  for (std::size_t i = 0; i < source.size(); ++i) {
    sum.cross +=
        weight_at(weights, i) * (target[i] - sum.target) * (source[i] - sum.source).transpose();
  }
  return sum;
}

RigidFit finish(const Eigen::Matrix3d& rotation, const Centred& at,
                std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target,
                std::span<const double> weights) {
  RigidFit fit;
  fit.target_from_source.linear() = rotation;
  fit.target_from_source.translation() = at.target - rotation * at.source;
  double squares = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    squares +=
        weight_at(weights, i) * (target[i] - fit.target_from_source * source[i]).squaredNorm();
  }
  fit.rms = std::sqrt(squares / at.weight);
  return fit;
}

}  // namespace

Result<RigidFit> fit_rigid(std::span<const Eigen::Vector3d> source,
                           std::span<const Eigen::Vector3d> target,
                           std::span<const double> weights) {
  const Result<Centred> at = centre(source, target, weights);
  if (!at) return pass(at);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(at->cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d spread = svd.singularValues();
  if (source.size() < 3 || !(spread.y() > 1e-9 * spread.x())) {
    return fail(ErrorCode::InvalidArgument, "rigid fit",
                "needs three pairs that do not lie on one line");
  }
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  return finish(rotation, *at, source, target, weights);
}

Result<RigidFit> fit_yaw(std::span<const Eigen::Vector3d> source,
                         std::span<const Eigen::Vector3d> target, std::span<const double> weights) {
  const Result<Centred> at = centre(source, target, weights);
  if (!at) return pass(at);
  const double cosine = at->cross(0, 0) + at->cross(2, 2);
  const double sine = at->cross(0, 2) - at->cross(2, 0);
  if (std::hypot(cosine, sine) < 1e-12) {
    return fail(ErrorCode::InvalidArgument, "yaw fit", "needs two pairs that differ horizontally");
  }
  const Eigen::Matrix3d rotation = about_y(std::atan2(sine, cosine)).toRotationMatrix();
  return finish(rotation, *at, source, target, weights);
}

}  // namespace chorus
