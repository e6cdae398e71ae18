#include "fusion-server/learn/fit_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "fusion-server/learn/boosting.h"

namespace chorus::learn {
namespace {

using fusion::ErrorPredictor;
using fusion::Features;
using fusion::JointPredictor;
using fusion::kFeatureCount;
using fusion::PredictorKind;

// Smaller errors count as this [m], because the logarithm of 0 is not finite.
constexpr double kLeastError = 1e-4;
// Share of a feature's variance that is added to it, so that a feature that never varies gets a
// coefficient of zero.
constexpr double kRidge = 1e-6;
constexpr double kLeastVariance = 1e-12;
// Between rounds, predictions stay within this of the mean's logarithm.
constexpr double kMostLog = 3.0;
constexpr double kLowest = 0.05;  // share of errors below JointPredictor::least
constexpr int kGammaRounds = 50;
constexpr double kConverged = 1e-9;

using Samples = std::vector<const ErrorSample*>;

std::array<Samples, kJointCount> by_joint(std::span<const ErrorSample> samples) {
  std::array<Samples, kJointCount> of;
  for (const ErrorSample& sample : samples) {
    if (std::isfinite(sample.error)) of[index_of(sample.joint)].push_back(&sample);
  }
  return of;
}

std::array<fusion::FeatureRange, kFeatureCount> ranges_of(std::span<const ErrorSample> samples) {
  std::array<fusion::FeatureRange, kFeatureCount> ranges;
  for (std::size_t f = 0; f < kFeatureCount; ++f) {
    double count = 0.0;
    double sum = 0.0;
    fusion::FeatureRange range{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity(), 0.0};
    for (const ErrorSample& sample : samples) {
      const double value = sample.features[f];
      if (!std::isfinite(value)) continue;
      range.least = std::min(range.least, value);
      range.most = std::max(range.most, value);
      sum += value;
      count += 1.0;
    }
    if (count > 0) ranges[f] = {range.least, range.most, sum / count};
  }
  return ranges;
}

bool uses(PredictorKind kind, std::size_t feature) {
  if (kind == PredictorKind::Constant) return false;
  return kind != PredictorKind::States ||
         feature == static_cast<std::size_t>(fusion::Feature::Inferred);
}

double mean_error(const Samples& samples) {
  double sum = 0.0;
  for (const ErrorSample* sample : samples) sum += std::max(kLeastError, sample->error);
  return sum / static_cast<double>(samples.size());
}

/// One row per sample: 1, then the features that the kind uses, minus their means over all joints.
class Design {
 public:
  Design(const Samples& samples, const ErrorPredictor& predictor) : predictor_(predictor) {
    for (std::size_t f = 0; f < kFeatureCount; ++f) {
      if (uses(predictor.kind, f)) used_.push_back(f);
    }
    rows_.resize(static_cast<Eigen::Index>(samples.size()),
                 static_cast<Eigen::Index>(used_.size()) + 1);
    for (Eigen::Index i = 0; i < rows_.rows(); ++i) {
      rows_(i, 0) = 1.0;
      for (std::size_t k = 0; k < used_.size(); ++k) {
        const double mean = predictor.ranges[used_[k]].mean;
        const double value = samples[static_cast<std::size_t>(i)]->features[used_[k]];
        rows_(i, static_cast<Eigen::Index>(k) + 1) = std::isfinite(value) ? value - mean : 0.0;
      }
    }
    Eigen::MatrixXd normal = rows_.transpose() * rows_;
    for (Eigen::Index k = 0; k < normal.rows(); ++k)
      normal(k, k) += kRidge * normal(k, k) + kLeastVariance;
    solver_.compute(normal);
  }

  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& target) const {
    return solver_.solve(rows_.transpose() * target);
  }
  [[nodiscard]] Eigen::VectorXd sums(const Eigen::VectorXd& weights) const {
    return rows_ * weights;
  }

  [[nodiscard]] JointPredictor joint_of(const Eigen::VectorXd& weights) const {
    JointPredictor joint;
    joint.constant = weights[0];
    for (std::size_t k = 0; k < used_.size(); ++k) {
      const double weight = weights[static_cast<Eigen::Index>(k) + 1];
      joint.coefficients[used_[k]] = weight;
      joint.constant -= weight * predictor_.ranges[used_[k]].mean;
    }
    return joint;
  }

 private:
  const ErrorPredictor& predictor_;
  std::vector<std::size_t> used_;
  Eigen::MatrixXd rows_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
};

Eigen::VectorXd errors_of(const Samples& samples) {
  Eigen::VectorXd errors(static_cast<Eigen::Index>(samples.size()));
  for (Eigen::Index i = 0; i < errors.size(); ++i)
    errors[i] = std::max(kLeastError, samples[static_cast<std::size_t>(i)]->error);
  return errors;
}

/// With log link all weights of the gamma distribution are 1, so one factorisation does:
///   beta <- (X'X)^-1 X' (eta + (y - mu) / mu),   mu = exp(eta),   eta = X beta
JointPredictor fit_gamma(const Samples& samples, const ErrorPredictor& predictor) {
  const Design design(samples, predictor);
  const Eigen::VectorXd errors = errors_of(samples);
  const double middle = std::log(errors.mean());
  Eigen::VectorXd eta = Eigen::VectorXd::Constant(errors.size(), middle);
  Eigen::VectorXd beta;
  for (int round = 0; round < kGammaRounds; ++round) {
    const Eigen::ArrayXd mu = eta.array().exp();
    const Eigen::VectorXd next = design.solve(eta.array() + (errors.array() - mu) / mu);
    const double moved = round == 0 ? 1.0 : (next - beta).cwiseAbs().maxCoeff();
    beta = next;
    eta = design.sums(beta).array().max(middle - kMostLog).min(middle + kMostLog);
    if (moved < kConverged) break;
  }
  return design.joint_of(beta);
}

JointPredictor fit_squares(const Samples& samples, const ErrorPredictor& predictor) {
  const Design design(samples, predictor);
  return design.joint_of(design.solve(errors_of(samples)));
}

Result<JointPredictor> fit_joint(const Samples& samples, const ErrorPredictor& predictor) {
  if (predictor.kind == PredictorKind::Gamma) return fit_gamma(samples, predictor);
  if (predictor.kind != PredictorKind::Boosting) return fit_squares(samples, predictor);
  std::vector<Features> features;
  std::vector<double> errors;
  for (const ErrorSample* sample : samples) {
    features.push_back(sample->features);
    errors.push_back(std::max(kLeastError, sample->error));
  }
  auto boosted = boost_errors(features, errors);
  if (!boosted) return pass(boosted);
  JointPredictor joint;
  joint.constant = std::log(mean_error(samples)) + boosted->constant;
  joint.trees = std::move(boosted->trees);
  return joint;
}

/// Sets the limits of predictions, and then JointPredictor::rms.
void scale(ErrorPredictor& predictor, JointId id, const Samples& samples) {
  Eigen::VectorXd errors = errors_of(samples);
  const auto low = errors.begin() + static_cast<Eigen::Index>(kLowest * double(errors.size()));
  std::nth_element(errors.begin(), low, errors.end());
  predictor.joints[index_of(id)]->least =
      std::clamp(*low, fusion::kLeastPrediction, fusion::kMostPrediction);
  predictor.joints[index_of(id)]->most =
      std::clamp(errors.maxCoeff(), fusion::kLeastPrediction, fusion::kMostPrediction);
  double sum = 0.0;
  for (const ErrorSample* sample : samples) {
    const double ratio = sample->error / *predicted_error(predictor, id, sample->features);
    sum += ratio * ratio;
  }
  predictor.joints[index_of(id)]->rms = std::sqrt(sum / static_cast<double>(samples.size()));
}

}  // namespace

Result<ErrorPredictor> fit_errors(std::span<const ErrorSample> samples, const FitOptions& options) {
  ErrorPredictor predictor;
  predictor.kind = options.kind;
  predictor.trained_on = options.trained_on;
  predictor.ranges = ranges_of(samples);
  const auto of = by_joint(samples);
  std::size_t most = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    most = std::max(most, of[j].size());
    if (of[j].empty() || of[j].size() < options.least_samples) continue;
    auto joint = fit_joint(of[j], predictor);
    if (!joint) return pass(joint);
    predictor.joints[j] = std::move(*joint);
    scale(predictor, static_cast<JointId>(j), of[j]);
  }
  if (std::ranges::any_of(predictor.joints, [](const auto& joint) { return joint.has_value(); }))
    return predictor;
  return fail(
      ErrorCode::InvalidArgument, "samples",
      fmt::format("are too few to learn errors from: {} of the joint that has the most, and "
                  "{} are needed; record more",
                  most, options.least_samples));
}

double prediction_error(const ErrorPredictor& predictor, std::span<const ErrorSample> samples) {
  double sum = 0.0;
  double count = 0.0;
  for (const ErrorSample& sample : samples) {
    const auto predicted = predicted_error(predictor, sample.joint, sample.features);
    if (!predicted) continue;
    sum += std::abs(*predicted - sample.error);
    count += 1.0;
  }
  return sum / count;
}

}  // namespace chorus::learn
