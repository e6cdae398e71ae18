// The report of `chorus calibrate place`.  Pure.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/calibration/place_verdict.h"

namespace chorus::ctl {

struct PlaceOutcome {
  std::string sensor;
  calibration::CameraPlace place;
  std::vector<calibration::PredictedError> errors;
  std::vector<std::string> weaknesses;
  std::vector<std::string> notes;  ///< What was left out and why.
};

[[nodiscard]] std::string place_text(const PlaceOutcome& outcome);
[[nodiscard]] nlohmann::json place_json(const PlaceOutcome& outcome);

}  // namespace chorus::ctl
