#include "fusion-server/registration/student_fit.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/rigid_fit.h"

namespace chorus::registration {
namespace {

constexpr double kFreedom = 4.0;  // heavy tails for a few wrong frames
constexpr double kDimensions = 3.0;
constexpr int kFitIterations = 12;
constexpr double kMinDeviation = 0.001;  // [m]
constexpr double kUncorrelated = 0.05;

struct Residuals {
  std::vector<Eigen::Vector3d> off;
  std::vector<double> weights;
  double variance = 1.0;  ///< Variance per axis [m^2].

  explicit Residuals(std::size_t count) : off(count), weights(count, 1.0) {}

  /// Updates the scale and then the weights: one step of expectation-maximisation.
  void reweigh() {
    double squares = 0.0;
    for (std::size_t i = 0; i < off.size(); ++i) squares += weights[i] * off[i].squaredNorm();
    variance = std::max(kMinDeviation * kMinDeviation,
                        squares / (kDimensions * static_cast<double>(off.size())));
    for (std::size_t i = 0; i < off.size(); ++i)
      weights[i] = (kFreedom + kDimensions) / (kFreedom + off[i].squaredNorm() / variance);
  }

  [[nodiscard]] double loss(std::size_t i) const {
    return kDimensions * std::log(variance) +
           (kFreedom + kDimensions) * std::log1p(off[i].squaredNorm() / (kFreedom * variance));
  }
};

/// Computes losses and weighted residuals of each frame, as means over its points.
void summarise(const Residuals& residuals, const std::vector<std::size_t>& frames,
               StudentFit& fit) {
  std::vector<Eigen::Vector3d> series;
  for (std::size_t i = 0; i < frames.size();) {
    Loss loss{frames[i], 0.0};
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (; i < frames.size() && frames[i] == loss.frame; ++i, ++count) {
      loss.value += residuals.loss(i);
      sum += std::sqrt(residuals.weights[i]) * residuals.off[i];
    }
    loss.value /= count;
    fit.losses.push_back(loss);
    series.push_back(sum / count);
  }
  fit.inflation = inflation_of(series);
}

}  // namespace

double inflation_of(const std::vector<Eigen::Vector3d>& series) {
  double same = 0.0;
  for (const Eigen::Vector3d& each : series) same += each.squaredNorm();
  if (!(same > 0.0)) return 1.0;
  double inflation = 1.0;
  for (std::size_t lag = 1; lag < series.size() / 3; ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < series.size(); ++i) product += series[i].dot(series[i - lag]);
    if (product < kUncorrelated * same) break;
    inflation += 2.0 * product / same;
  }
  return inflation;
}

std::optional<StudentFit> fit_place(const Points& points, bool levelled) {
  Residuals residuals(points.target.size());
  StudentFit fit;
  for (int i = 0; i < kFitIterations; ++i) {
    const auto rigid = levelled ? fit_yaw(points.source, points.target, residuals.weights)
                                : fit_rigid(points.source, points.target, residuals.weights);
    if (!rigid) return std::nullopt;
    fit.target_from_source = rigid->target_from_source;
    for (std::size_t k = 0; k < residuals.off.size(); ++k)
      residuals.off[k] = points.target[k] - fit.target_from_source * points.source[k];
    residuals.reweigh();
  }
  summarise(residuals, points.frame, fit);
  return fit;
}

}  // namespace chorus::registration
