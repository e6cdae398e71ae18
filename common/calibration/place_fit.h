// The least-squares problem behind place.h.  Private to this folder and its tests.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "common/calibration/place.h"

namespace chorus::calibration {

/// Where a board was moved on the floor after the first sight.
struct MovedBoard {
  bool moved = false;  ///< False: it stands where it stood in the first sight.
  double x = 0.0;      ///< [m]
  double z = 0.0;      ///< [m]
  double yaw = 0.0;    ///< [rad]
};

struct PlaceGuess {
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();  ///< OpenCV's axes.
  double focal = 0.0;              ///< Relative error of the focal length.
  std::vector<MovedBoard> boards;  ///< One for each sight.
};

struct PlaceFit {
  PlaceGuess guess;
  Eigen::Matrix<double, 7, 7> covariance;  ///< Rotation vector, position, focal.
  double squares = 0.0;                    ///< Sum of squared residuals [variances].
  double error_px = 0.0;
  double freedom = 1.0;  ///< Residuals less parameters.
};

/// The world point of a board's point in its first place.
[[nodiscard]] Eigen::Vector3d world_point(const PlaceQuestion& question,
                                          const Eigen::Vector2d& on_board);

/// Refines a guess; none where a point comes to lie behind the camera or a step cannot be computed.
[[nodiscard]] std::optional<PlaceFit> refine(const PlaceQuestion& question, PlaceGuess guess);

}  // namespace chorus::calibration
