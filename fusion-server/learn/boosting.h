// Gradient boosting with Debian's XGBoost, for training alone.
//
// The library (package libxgboost0) is loaded when somebody trains, so that neither the fusion
// server nor its package depends on it; its trees are evaluated by fusion::predicted_error().
#pragma once

#include <span>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/fusion/error_predictor.h"

namespace chorus::learn {

/// log(error) = log(mean of all errors) + constant + sum of the trees' leaves.
struct Boosted {
  double constant = 0.0;
  std::vector<fusion::ErrorTree> trees;
};

/// Boosts trees that minimise the gamma deviance of one joint's errors [m], which must be positive.
/// Before they are returned, our evaluation of the trees is compared with the library's for every
/// sample.  Unavailable if the library is not installed.
[[nodiscard]] Result<Boosted> boost_errors(std::span<const fusion::Features> features,
                                           std::span<const double> errors);

/// Whether the library is installed.
[[nodiscard]] bool can_boost();

}  // namespace chorus::learn
