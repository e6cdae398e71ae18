#include "fusion-server/registration/robust_fit.h"

#include <algorithm>
#include <cmath>

#include "common/base/median.h"
#include "fusion-server/registration/tukey.h"

namespace chorus::registration {
namespace {

constexpr double kCutoff = 3.0;  // c of Geman-McClure in standard deviations
constexpr double kAnneal = 1.4;  // mu <- mu / 1.4
constexpr int kTukeyIterations = 8;
constexpr double kAgreeingShare = 0.5;
constexpr int kMaxDoublings = 5;

/// The pairs as columns of matrices, as the closed form needs them.
struct Columns {
  std::vector<Eigen::Vector3d> source;
  std::vector<Eigen::Vector3d> target;
  std::vector<double> sigma;

  [[nodiscard]] std::size_t size() const { return sigma.size(); }
};

Columns columns_of(const std::vector<Pair>& pairs) {
  Columns columns;
  for (const Pair& pair : pairs) {
    columns.source.push_back(pair.x_in_source);
    columns.target.push_back(pair.x_in_target);
    columns.sigma.push_back(pair.sigma);
  }
  return columns;
}

Result<RigidFit> fit_once(const Columns& columns, const std::vector<double>& robust,
                          Freedom freedom) {
  std::vector<double> weights(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    weights[i] = robust[i] / (columns.sigma[i] * columns.sigma[i]);
  }
  return freedom == Freedom::Yaw ? fit_yaw(columns.source, columns.target, weights)
                                 : fit_rigid(columns.source, columns.target, weights);
}

/// Residual norms in units of each pair's sigma.
std::vector<double> residuals(const Columns& columns, const Eigen::Isometry3d& target_from_source) {
  std::vector<double> norms(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Eigen::Vector3d off = columns.target[i] - target_from_source * columns.source[i];
    norms[i] = off.norm() / columns.sigma[i];
  }
  return norms;
}

/// Geman-McClure loss with graduated non-convexity; `cutoff` is in units of the pairs' sigmas.
Result<RigidFit> anneal(const Columns& columns, Freedom freedom, double cutoff) {
  Result<RigidFit> fit = fit_once(columns, std::vector<double>(columns.size(), 1.0), freedom);
  if (!fit) return fit;
  std::vector<double> norms = residuals(columns, fit->target_from_source);
  const double widest = *std::max_element(norms.begin(), norms.end());
  double mu = std::max(1.0, 2.0 * widest * widest / (cutoff * cutoff));
  std::vector<double> weights(columns.size());
  for (bool last = false; !last; mu = std::max(1.0, mu / kAnneal)) {
    last = mu <= 1.0;
    const double bound = mu * cutoff * cutoff;
    for (std::size_t i = 0; i < norms.size(); ++i) {
      const double root = bound / (norms[i] * norms[i] + bound);
      weights[i] = root * root;
    }
    fit = fit_once(columns, weights, freedom);
    if (!fit) return fit;
    norms = residuals(columns, fit->target_from_source);
  }
  return fit;
}

double share_within(const std::vector<double>& norms, double cutoff) {
  const auto agree =
      std::count_if(norms.begin(), norms.end(), [&](double norm) { return norm < cutoff; });
  return static_cast<double>(agree) / static_cast<double>(norms.size());
}

RobustFit summarise(const Columns& columns, const RigidFit& fit, std::vector<double> weights) {
  RobustFit result;
  result.target_from_source = fit.target_from_source;
  double squares = 0.0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    ++result.inliers;
    squares += (columns.target[i] - fit.target_from_source * columns.source[i]).squaredNorm();
  }
  if (result.inliers > 0) result.rms = std::sqrt(squares / static_cast<double>(result.inliers));
  result.weights = std::move(weights);
  return result;
}

/// Tukey's biweight, scaled by the median residual, or by `cutoff` if that is smaller.
Result<RobustFit> polish(const Columns& columns, Freedom freedom, RigidFit fit, double cutoff) {
  std::vector<double> weights(columns.size());
  double scale = 0.0;
  for (int i = 0; i < kTukeyIterations; ++i) {
    const std::vector<double> norms = residuals(columns, fit.target_from_source);
    const double typical = std::min(median(norms) / kMedianToSigma, cutoff / kCutoff);
    scale = std::max(kMinScale, typical);
    for (std::size_t k = 0; k < norms.size(); ++k) {
      const double off = norms[k] / (kTukey * scale);
      weights[k] = tukey_weight(off * off);
    }
    const Result<RigidFit> next = fit_once(columns, weights, freedom);
    if (!next) return pass(next);
    fit = *next;
  }
  RobustFit result = summarise(columns, fit, std::move(weights));
  result.scale = scale;
  return result;
}

}  // namespace

Result<RobustFit> fit_robustly(const std::vector<Pair>& pairs, Freedom freedom,
                               double sigma_factor) {
  const Columns columns = columns_of(pairs);
  double cutoff = kCutoff * sigma_factor;
  Result<RigidFit> fit = anneal(columns, freedom, cutoff);
  for (int i = 0; fit && i < kMaxDoublings; ++i) {
    const std::vector<double> norms = residuals(columns, fit->target_from_source);
    if (share_within(norms, cutoff) >= kAgreeingShare) break;
    cutoff *= 2.0;
    fit = anneal(columns, freedom, cutoff);
  }
  if (!fit) return pass(fit);
  return polish(columns, freedom, *fit, cutoff);
}

}  // namespace chorus::registration
