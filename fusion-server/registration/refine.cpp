#include "fusion-server/registration/refine.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/geometry/rotation.h"

namespace chorus::registration {
namespace {

constexpr int kIterations = 6;
constexpr double kMostCorrelated = 0.98;  // rho beyond this says "constant error", not "no samples"
constexpr double kTiny = 1e-12;
constexpr double kRidge = 1e-9;  // keeps an unobserved direction finite instead of NaN

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Row6 = Eigen::Matrix<double, 1, 6>;

/// Normal equations of small motions (omega, tau) on the target side.
struct Normal {
  Matrix6 information = kRidge * Matrix6::Identity();
  Vector6 right = Vector6::Zero();

  void add(const Row6& row, double residual, double weight) {
    information += weight * row.transpose() * row;
    right += weight * row.transpose() * residual;
  }
};

/// target - q with q = target_from_source * source: d/d omega = [q]x, d/d tau = -1; residual to be
/// removed.
void add_pair(Normal& normal, const Pair& pair, const Eigen::Isometry3d& target_from_source,
              double weight) {
  const Eigen::Vector3d q = target_from_source * pair.x_in_source;
  const Eigen::Vector3d off = pair.x_in_target - q;
  const Eigen::Matrix<double, 3, 6> rows = at_point(q).bottomRows<3>();
  normal.information += weight * rows.transpose() * rows;
  normal.right += weight * rows.transpose() * off;
}

/// Up must stay up, and the floor under the walk must stay the floor.
void add_prior(Normal& normal, const FloorPrior& prior, const Eigen::Isometry3d& target_from_source,
               const Eigen::Vector3d& centre_in_source) {
  if (prior.tilt > 0) {
    const Eigen::Vector3d up = target_from_source.linear() * Eigen::Vector3d::UnitY();
    const double weight = 1.0 / (prior.tilt * prior.tilt);
    Row6 along_x = Row6::Zero();
    along_x << 0, up.z(), -up.y(), 0, 0, 0;
    Row6 along_z = Row6::Zero();
    along_z << up.y(), -up.x(), 0, 0, 0, 0;
    normal.add(along_x, -up.x(), weight);
    normal.add(along_z, -up.z(), weight);
  }
  if (prior.height > 0) {
    const Eigen::Vector3d below(centre_in_source.x(), 0, centre_in_source.z());
    const Eigen::Vector3d q = target_from_source * below;
    Row6 row;
    row << -q.z(), 0, q.x(), 0, 1, 0;
    normal.add(row, -q.y(), 1.0 / (prior.height * prior.height));
  }
}

Eigen::Vector3d centre_of(const std::vector<Pair>& pairs, const std::vector<double>& weights) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    sum += weights[i] * pairs[i].x_in_source;
    total += weights[i];
  }
  return total > 0 ? Eigen::Vector3d(sum / total) : sum;
}

/// Mean whitened residual of each instant, and what one pair alone scatters.
struct Instants {
  std::vector<Eigen::Vector3d> means;
  double pair_variance = 0.0;  ///< Per axis.
  double pairs_per_instant = 0.0;
};

Instants instants_of(const std::vector<Pair>& pairs, const RobustFit& fit) {
  Instants instants;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0;
  std::size_t in_sum = 0;
  std::size_t used = 0;
  const auto close = [&] {
    if (in_sum > 0) instants.means.push_back(sum / static_cast<double>(in_sum));
    sum.setZero();
    in_sum = 0;
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0 && pairs[i].instant != pairs[i - 1].instant) close();
    if (!(fit.weights[i] > 0)) continue;
    const Eigen::Vector3d off =
        (pairs[i].x_in_target - fit.target_from_source * pairs[i].x_in_source) / pairs[i].sigma;
    sum += off;
    squares += off.squaredNorm();
    ++in_sum;
    ++used;
  }
  close();
  if (used == 0 || instants.means.empty()) return instants;
  instants.pair_variance = squares / (3.0 * static_cast<double>(used));
  instants.pairs_per_instant =
      static_cast<double>(used) / static_cast<double>(instants.means.size());
  return instants;
}

}  // namespace

double rms_of(const std::vector<Pair>& pairs, const std::vector<double>& weights,
              const Eigen::Isometry3d& target_from_source) {
  double squares = 0.0;
  std::size_t used = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    squares += (pairs[i].x_in_target - target_from_source * pairs[i].x_in_source).squaredNorm();
    ++used;
  }
  return used > 0 ? std::sqrt(squares / static_cast<double>(used)) : 0.0;
}

double inflation_of(const std::vector<Pair>& pairs, const RobustFit& fit) {
  const Instants instants = instants_of(pairs, fit);
  double same = 0.0;
  double next = 0.0;
  for (std::size_t i = 0; i < instants.means.size(); ++i) {
    same += instants.means[i].squaredNorm();
    if (i > 0) next += instants.means[i].dot(instants.means[i - 1]);
  }
  if (!(same > kTiny) || !(instants.pair_variance > kTiny)) return 1.0;
  const double rho = std::clamp(next / same, 0.0, kMostCorrelated);
  const double mean_variance = same / (3.0 * static_cast<double>(instants.means.size()));
  const double joints = mean_variance * instants.pairs_per_instant / instants.pair_variance;
  return std::max(1.0, joints) * (1.0 + rho) / (1.0 - rho);
}

Refined refine(const std::vector<Pair>& pairs, const RobustFit& fit, const FloorPrior& prior) {
  Refined refined;
  refined.target_from_source = fit.target_from_source;
  refined.inflation = inflation_of(pairs, fit);
  const Eigen::Vector3d centre = centre_of(pairs, fit.weights);
  const double scale = std::max(fit.scale, kTiny);
  Matrix6 information = Matrix6::Identity();
  for (int i = 0; i < kIterations; ++i) {
    Normal normal;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (!(fit.weights[k] > 0)) continue;
      const double sigma = scale * pairs[k].sigma;
      const double weight = fit.weights[k] / (sigma * sigma * refined.inflation);
      add_pair(normal, pairs[k], refined.target_from_source, weight);
    }
    add_prior(normal, prior, refined.target_from_source, centre);
    information = normal.information;
    const Vector6 motion = information.ldlt().solve(normal.right);
    if (!motion.allFinite()) break;
    Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
    step.linear() = exp_map(motion.head<3>()).toRotationMatrix();
    step.translation() = motion.tail<3>();
    refined.target_from_source = step * refined.target_from_source;
  }
  refined.covariance = information.ldlt().solve(Matrix6::Identity());
  return refined;
}

}  // namespace chorus::registration
