// The output of `chorus calibrate camera`, for people and as JSON.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/calibration/calibrate.h"
#include "services/ctl/calibrate/board_pictures.h"

namespace chorus::ctl {

/// A table of the views, the lens with its standard deviations, and what does not suffice.
[[nodiscard]] std::string calibration_text(const calibration::Calibration& calibration,
                                           const BoardViews& found,
                                           const std::vector<std::string>& weaknesses);

[[nodiscard]] nlohmann::json calibration_json(const calibration::Calibration& calibration,
                                              const BoardViews& found,
                                              const std::vector<std::string>& weaknesses);

}  // namespace chorus::ctl
