// Whether a calibration is good enough, and what to do if it is not.  All functions are pure.
#pragma once

#include <string>
#include <vector>

#include "common/calibration/calibrate.h"

namespace chorus::calibration {

/// What a calibration must achieve; otherwise it is refused.
struct Demands {
  std::size_t views = 12;
  std::size_t tilted_views = 3;
  double tilt = 0.35;          ///< Least angle of a tilted view [rad]: 20 degrees.
  double share = 0.04;         ///< Least share of all corners in each outer third of the picture.
  double focal_sigma = 0.01;   ///< Largest standard deviation of the focal length, relative to it.
  double error_share = 0.001;  ///< Largest error_px, relative to the picture's longer side.
};

/// One sentence for each weakness, saying what to do ("no board in the left third ..."); empty if
/// the calibration is good.
[[nodiscard]] std::vector<std::string> weaknesses(const Calibration& calibration,
                                                  const Demands& demands = {});

/// weaknesses() where there are too few views for a calibration.
[[nodiscard]] std::vector<std::string> missing_views(const std::vector<View>& views,
                                                     PictureSize size, const Demands& demands = {});

}  // namespace chorus::calibration
