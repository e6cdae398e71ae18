#include "common/evaluation/park.h"

#include <random>
#include <utility>

#include <Eigen/SVD>

#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

// Singular values of M below this share of the largest: all axes are one.
constexpr double kOneAxis = 1e-6;

std::vector<std::pair<std::size_t, std::size_t>> instants(std::size_t count,
                                                          const ParkOptions& options) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  if (count < 2) return out;
  std::mt19937_64 draw(options.seed);
  std::uniform_int_distribution<std::size_t> any(0, count - 1);
  while (out.size() < options.pairs) {
    const std::size_t s = any(draw);
    const std::size_t t = any(draw);
    if (s != t) out.emplace_back(s, t);
  }
  return out;
}

}  // namespace

Result<Eigen::Quaterniond> park_martin(const std::vector<RotationPair>& pairs) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (const RotationPair& each : pairs) m += log_map(each.b) * log_map(each.a).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& values = svd.singularValues();
  if (!m.allFinite() || !(values(1) > kOneAxis * values(0)) || !(values(0) > 0))
    return fail(ErrorCode::InvalidArgument, "calibration",
                "the limb turned about one axis alone; turn it about a second one");
  // (M^T M)^(-1/2) M^T = V U^T for M = U S V^T, with the sign of the smallest so that det = 1.
  Eigen::Vector3d signs(1, 1, 1);
  signs(2) = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1.0 : 1.0;
  const Eigen::Matrix3d x = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
  return normalised_or_identity(Eigen::Quaterniond(x));
}

std::vector<RotationPair> local_pairs(const OrientationPairs& pairs, const ParkOptions& options) {
  std::vector<RotationPair> out;
  for (const auto& [s, t] : instants(pairs.size(), options)) {
    out.push_back(
        {pairs[s].inertial_from_sensor.conjugate() * pairs[t].inertial_from_sensor,
         pairs[s].tracked.world_from_limb.conjugate() * pairs[t].tracked.world_from_limb});
  }
  return out;
}

Result<ParkCalibration> park_calibration(const OrientationPairs& pairs,
                                         const ParkOptions& options) {
  const auto local = park_martin(local_pairs(pairs, options));  // q^X = conj(q^L)
  if (!local) return pass(local);
  std::vector<RotationPair> dual;
  for (const auto& [s, t] : instants(pairs.size(), options)) {
    dual.push_back(
        {pairs[s].inertial_from_sensor * pairs[t].inertial_from_sensor.conjugate(),
         pairs[s].tracked.world_from_limb * pairs[t].tracked.world_from_limb.conjugate()});
  }
  const auto global = park_martin(dual);  // A conj(q^G) = conj(q^G) B
  if (!global) return pass(global);
  return ParkCalibration{global->conjugate(), local->conjugate()};
}

}  // namespace chorus::evaluation
