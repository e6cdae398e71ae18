// Learned errors (Otto et al., Section 6): the expected distance of one view's joint from the true
// joint, as a function of the view's features.
//
// A predictor is a value without behaviour of its own: coefficients, or regression trees, for each
// joint.  chorus::learn fits it and reads it from a file.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fusion-server/fusion/joint_features.h"

namespace chorus::fusion {

enum class PredictorKind : std::uint8_t {
  Constant,  ///< One number for each joint: what the others have to be better than.
  States,    ///< Linear in the joint's state.
  Linear,    ///< Linear in all features.
  Gamma,     ///< Gamma regression with log link: exp of a linear function of all features.
  Boosting,  ///< Sum of regression trees over all features.
};
inline constexpr std::array<std::string_view, 5> kPredictorNames{"constant", "states", "linear",
                                                                 "gamma", "boosting"};

/// An inner node passes on to `yes` if the feature is below `value`, else to `no`; an unknown
/// feature goes to `yes` if `unknown_yes`.  A leaf (feature < 0) adds `value` to the prediction.
/// Features and thresholds are compared in single precision, as they were in training.
struct TreeNode {
  int feature = -1;
  double value = 0.0;
  int yes = 0;
  int no = 0;
  bool unknown_yes = true;

  bool operator==(const TreeNode&) const = default;
};
/// The root comes first, children come after their parents.
using ErrorTree = std::vector<TreeNode>;

/// Limits of every prediction [m].
inline constexpr double kLeastPrediction = 1e-3;
inline constexpr double kMostPrediction = 1.0;

struct JointPredictor {
  /// Root mean square of (error / predicted error) in training.  The prediction times this is the
  /// root mean square error, from which the stated covariance is made.
  double rms = 1.0;
  /// Limits of predictions [m]: the 5th percentile and the largest of the errors in training.  A
  /// linear prediction can fall below zero; its view would then outvote all others.
  double least = kLeastPrediction;
  double most = kMostPrediction;
  double constant = 0.0;              ///< [m], or log(m) with log link.
  Features coefficients = {};         ///< Not of Boosting.
  std::vector<ErrorTree> trees = {};  ///< Of Boosting alone.

  bool operator==(const JointPredictor&) const = default;
};

/// The values of a feature in training.  Predictions never extrapolate beyond them.
struct FeatureRange {
  double least = 0.0;
  double most = 0.0;
  double mean = 0.0;  ///< Replaces an unknown value, except in trees.

  bool operator==(const FeatureRange&) const = default;
};

struct ErrorPredictor {
  PredictorKind kind = PredictorKind::Constant;
  std::string trained_on = {};  ///< For people: which recordings.
  std::array<FeatureRange, kFeatureCount> ranges = {};
  /// None: too little was known of the joint, and nothing is predicted.
  std::array<std::optional<JointPredictor>, kJointCount> joints = {};

  bool operator==(const ErrorPredictor&) const = default;
};

/// A predictor that copies share; none by default.  Equal if the predictors are.
struct SharedPredictor {
  std::shared_ptr<const ErrorPredictor> model = {};

  friend bool operator==(const SharedPredictor& a, const SharedPredictor& b) {
    return a.model == b.model || (a.model && b.model && *a.model == *b.model);
  }
};

/// Whether exp() turns sums into predictions.
[[nodiscard]] bool has_log_link(PredictorKind kind);

/// Expected distance from the true joint [m], within the joint's limits; none if the joint has no
/// predictor.
[[nodiscard]] std::optional<double> predicted_error(const ErrorPredictor& predictor, JointId joint,
                                                    const Features& features);

/// Sum of a joint's constant, coefficients and trees, before the link.
[[nodiscard]] double linear_sum(const ErrorPredictor& predictor, const JointPredictor& joint,
                                const Features& features);

}  // namespace chorus::fusion
