// Error predictors as files: JSON, written by `chorus train-error` and read by the fusion server.
//
//   {"format": "chorus-error-model", "version": 1, "kind": "gamma", "trainedOn": "...",
//    "features": {"turn_rad": {"least": 0, "most": 3.1, "mean": 1.2}, ...},
//    "joints": {"Head": {"rms": 1.2, "least": 0.004, "most": 0.3, "constant": -4.1, "coefficients":
//    {"turn_rad": 0.3, ...}}}}
//
// Boosting has "trees" in place of "coefficients": arrays of nodes, each either [value] or
// [feature, value, yes, no, unknownYes], as in fusion::TreeNode.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "fusion-server/fusion/error_predictor.h"

namespace chorus::learn {

[[nodiscard]] std::string write_predictor(const fusion::ErrorPredictor& predictor);

/// An error names the part of the text that is wrong, and what it should be.
[[nodiscard]] Result<fusion::ErrorPredictor> read_predictor(std::string_view text);

/// read_predictor() of a file, whose name begins the context of errors.
[[nodiscard]] Result<fusion::SharedPredictor> load_predictor(const std::filesystem::path& file);

}  // namespace chorus::learn
