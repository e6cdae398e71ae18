#include "fusion-server/fusion/error_predictor.h"

#include <algorithm>
#include <cmath>

namespace chorus::fusion {
namespace {

double leaf_of(const ErrorTree& tree, const Features& features) {
  std::size_t at = 0;
  while (tree[at].feature >= 0) {
    const TreeNode& node = tree[at];
    const double value = features[static_cast<std::size_t>(node.feature)];
    const bool yes = std::isnan(value) ? node.unknown_yes
                                       : static_cast<float>(value) < static_cast<float>(node.value);
    at = static_cast<std::size_t>(yes ? node.yes : node.no);
  }
  return tree[at].value;
}

}  // namespace

bool has_log_link(PredictorKind kind) {
  return kind == PredictorKind::Gamma || kind == PredictorKind::Boosting;
}

double linear_sum(const ErrorPredictor& predictor, const JointPredictor& joint,
                  const Features& features) {
  double sum = joint.constant;
  for (std::size_t f = 0; f < kFeatureCount; ++f) {
    if (joint.coefficients[f] == 0.0) continue;
    const FeatureRange& range = predictor.ranges[f];
    const double value = std::isnan(features[f]) ? range.mean : features[f];
    sum += joint.coefficients[f] * std::clamp(value, range.least, range.most);
  }
  for (const ErrorTree& tree : joint.trees) sum += leaf_of(tree, features);
  return sum;
}

std::optional<double> predicted_error(const ErrorPredictor& predictor, JointId id,
                                      const Features& features) {
  const auto& joint = predictor.joints[index_of(id)];
  if (!joint) return std::nullopt;
  const double sum = linear_sum(predictor, *joint, features);
  const double error = has_log_link(predictor.kind) ? std::exp(sum) : sum;
  // A sum that is not a number comes from coefficients near the limits of double alone.
  return std::isnan(error) ? joint->most : std::clamp(error, joint->least, joint->most);
}

}  // namespace chorus::fusion
