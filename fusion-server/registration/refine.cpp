#include "fusion-server/registration/refine.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/median.h"
#include "common/geometry/rotation.h"
#include "fusion-server/registration/tukey.h"

namespace chorus::registration {
namespace {

constexpr int kRefiningIterations = 15;
constexpr double kRefineSettled = 1e-7;  // [rad], [m]
// Upper limit of rho: at 1, as for a constant error, no independent pair would be left.
constexpr double kMaxCorrelated = 0.98;
constexpr double kTiny = 1e-12;
constexpr double kAxes = 3.0;

/// One pair at the present pose: its residual and S^-1.
struct Residual {
  Eigen::Vector3d off;
  Eigen::Matrix3d information;

  [[nodiscard]] double squared() const { return off.dot(information * off); }
};

Residual residual_of(const Pair& pair, const Eigen::Isometry3d& target_from_source,
                     double along_ratio) {
  const double extra = std::max(0.0, along_ratio * along_ratio - 1.0);
  const Eigen::Vector3d source_ray = target_from_source.linear() * pair.ray_in_source;
  const Eigen::Matrix3d shape = Eigen::Matrix3d::Identity() +
                                0.5 * extra * pair.ray_in_target * pair.ray_in_target.transpose() +
                                0.5 * extra * source_ray * source_ray.transpose();
  return {pair.x_in_target - target_from_source * pair.x_in_source,
          shape.inverse() / (pair.sigma * pair.sigma)};
}

std::vector<Residual> residuals_of(const std::vector<Pair>& pairs,
                                   const Eigen::Isometry3d& target_from_source,
                                   double along_ratio) {
  std::vector<Residual> residuals;
  residuals.reserve(pairs.size());
  for (const Pair& pair : pairs) {
    residuals.push_back(residual_of(pair, target_from_source, along_ratio));
  }
  return residuals;
}

/// Sets Tukey's weights, scaled by the median over the pairs that count so far.
void reweigh(const std::vector<Residual>& residuals, Refined& refined) {
  std::vector<double> norms;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (refined.weights[i] > 0) norms.push_back(std::sqrt(residuals[i].squared()));
  }
  if (norms.empty()) return;
  refined.scale = std::max(kMinScale, median(std::move(norms)) / kMedianToSigma);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double limit = kTukey * refined.scale;
    refined.weights[i] = tukey_weight(residuals[i].squared() / (limit * limit));
  }
}

void add_pair(Normal& normal, const Eigen::Vector3d& point_in_target, const Residual& residual,
              double weight) {
  const Eigen::Matrix<double, 3, 6> rows = at_point(point_in_target).bottomRows<3>();
  const Eigen::Matrix<double, 6, 3> weighted = weight * rows.transpose() * residual.information;
  normal.information += weighted * rows;
  normal.right += weighted * residual.off;
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

/// The mean whitened residual of each instant, and the scatter of single pairs.
struct Instants {
  std::vector<Eigen::Vector3d> means;
  double squares = 0.0;
  std::size_t used = 0;
};

Instants instants_of(const std::vector<Pair>& pairs, const std::vector<Residual>& residuals,
                     const std::vector<double>& weights) {
  Instants instants;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t in_sum = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (weights[i] > 0) {
      const Eigen::Matrix3d root = residuals[i].information.llt().matrixU();
      const Eigen::Vector3d white = root * residuals[i].off;
      sum += white;
      instants.squares += white.squaredNorm();
      ++in_sum;
      ++instants.used;
    }
    const bool last = i + 1 == pairs.size() || pairs[i + 1].instant != pairs[i].instant;
    if (!last || in_sum == 0) continue;
    instants.means.push_back(sum / static_cast<double>(in_sum));
    sum.setZero();
    in_sum = 0;
  }
  return instants;
}

/// Number of pairs per independent pair, computed from the lag-1 autocorrelation of the instants
/// and the correlation of the joints within an instant.
double inflation_of(const Instants& instants) {
  double same = 0.0;
  double next = 0.0;
  for (std::size_t i = 0; i < instants.means.size(); ++i) {
    same += instants.means[i].squaredNorm();
    if (i > 0) next += instants.means[i].dot(instants.means[i - 1]);
  }
  if (!(same > kTiny) || !(instants.squares > kTiny)) return 1.0;
  const double rho = std::clamp(next / same, 0.0, kMaxCorrelated);
  const double used = static_cast<double>(instants.used);
  const double count = static_cast<double>(instants.means.size());
  const double pair_variance = instants.squares / (kAxes * used);
  const double independent_mean_variance = pair_variance * count / used;
  const double joints = same / (kAxes * count) / independent_mean_variance;
  return std::max(1.0, joints) * (1.0 + rho) / (1.0 - rho);
}

Normal equations(const std::vector<Pair>& pairs, const std::vector<Residual>& residuals,
                 const Refined& at) {
  Normal normal;
  const double variance = at.scale * at.scale * at.inflation;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!(at.weights[i] > 0)) continue;
    const Eigen::Vector3d point = at.target_from_source * pairs[i].x_in_source;
    add_pair(normal, point, residuals[i], at.weights[i] / variance);
  }
  return normal;
}

void move(Refined& refined, const Vector6& motion) {
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  step.linear() = exp_map(motion.head<3>()).toRotationMatrix();
  step.translation() = motion.tail<3>();
  refined.target_from_source = step * refined.target_from_source;
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

double cost_of(const std::vector<Pair>& pairs, const Refined& at, double along_ratio) {
  double cost = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!(at.weights[i] > 0)) continue;
    cost += at.weights[i] * residual_of(pairs[i], at.target_from_source, along_ratio).squared();
  }
  return cost;
}

Refined refine(const std::vector<Pair>& pairs, const RobustFit& fit, const FloorPrior& prior,
               double along_ratio) {
  Refined refined;
  refined.target_from_source = fit.target_from_source;
  refined.weights = fit.weights;
  const Eigen::Vector3d centre = centre_of(pairs, fit.weights);
  Matrix6 information = Matrix6::Identity();
  for (int i = 0; i < kRefiningIterations; ++i) {
    const auto residuals = residuals_of(pairs, refined.target_from_source, along_ratio);
    reweigh(residuals, refined);
    refined.inflation = inflation_of(instants_of(pairs, residuals, refined.weights));
    Normal normal = equations(pairs, residuals, refined);
    add_prior(normal, prior, refined.target_from_source, centre);
    information = normal.information;
    const Vector6 motion = information.ldlt().solve(normal.right);
    if (!motion.allFinite()) break;
    move(refined, motion);
    if (motion.norm() < kRefineSettled) break;
  }
  refined.covariance = information.ldlt().solve(Matrix6::Identity());
  return refined;
}

}  // namespace chorus::registration
