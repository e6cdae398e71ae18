// The lens of a camera from views of a board (Z. Zhang, "A flexible new technique for camera
// calibration", 2000, as implemented in OpenCV), with its uncertainty.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/calibration/view.h"
#include "common/sensor/camera_image.h"

namespace chorus::calibration {

struct SolvedView {
  View view;
  double error_px = 0.0;  ///< Root mean square reprojection error of its corners.
  double tilt = 0.0;      ///< Angle between the board and the picture's plane [rad].
  bool used = true;       ///< False: left out, because it does not fit the others.
};

struct Calibration {
  Intrinsics intrinsics;  ///< Only with width and height where these views are of another board.
  /// Standard deviations, in the intrinsics' units: fx, fy, cx, cy, k1, k2, p1, p2, k3 (of a
  /// fisheye k1, k2, k3, k4, 0).
  std::array<double, 9> sigma{};
  double error_px = 0.0;  ///< Root mean square reprojection error over all used views.
  std::vector<SolvedView> views;

  /// Standard deviation of the focal length, relative to it.
  [[nodiscard]] double focal_sigma() const;
  [[nodiscard]] std::size_t used() const;
};

/// Views that do not fit the others are left out, at most a third of them.  k3 is estimated only
/// if the views show that it is needed.  InvalidArgument with fewer than three views, or if
/// nothing fits.  Does not solve for a lens, and states the error, if the corners are so far from
/// their places that the board is another one.
[[nodiscard]] Result<Calibration> calibrate(const std::vector<View>& views, PictureSize size,
                                            LensModel model = LensModel::Brown);

}  // namespace chorus::calibration
