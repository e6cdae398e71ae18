// Fits the error predictors of Otto et al., Section 6 (FusionKit's), each joint on its own.
#pragma once

#include <span>
#include <string>

#include "common/base/result.h"
#include "fusion-server/fusion/error_predictor.h"
#include "fusion-server/learn/error_samples.h"

namespace chorus::learn {

struct FitOptions {
  fusion::PredictorKind kind = fusion::PredictorKind::Gamma;
  /// Joints with fewer samples get no predictor.
  std::size_t least_samples = 300;
  std::string trained_on = {};  ///< ErrorPredictor::trained_on
};

/// Fits by least squares (Constant, States, Linear), by iteratively re-weighted least squares
/// (Gamma), or by gradient boosting with Debian's XGBoost (Boosting; gamma deviance, log link).
/// InvalidArgument if no joint has enough samples; Unavailable if Boosting lacks its library.
[[nodiscard]] Result<fusion::ErrorPredictor> fit_errors(std::span<const ErrorSample> samples,
                                                        const FitOptions& options);

/// Mean distance between predicted and true errors [m], over the samples of joints that the
/// predictor knows; NaN if there are none.
[[nodiscard]] double prediction_error(const fusion::ErrorPredictor& predictor,
                                      std::span<const ErrorSample> samples);

}  // namespace chorus::learn
