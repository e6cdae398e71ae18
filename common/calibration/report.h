// The result of a calibration, for people and for programs.
#pragma once

#include <string>

#include "common/calibration/calibrate.h"

namespace chorus::calibration {

/// {"width", "height", "fx", "fy", "cx", "cy", "distortion", "focal_sigma_percent"}: the keys of
/// device.camera.intrinsics.
[[nodiscard]] std::string intrinsics_json(const Intrinsics& camera, double focal_sigma);

/// A PNG as large as the pictures.  It shows every corner, green in used views and red in views
/// that were left out, and lines between the thirds.
[[nodiscard]] Result<std::string> coverage_png(const std::vector<SolvedView>& views,
                                               PictureSize size);

}  // namespace chorus::calibration
