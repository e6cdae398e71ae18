// Pictures of a calibration board through a known lens, or only the corners in such a picture.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/calibration/board.h"
#include "common/calibration/view.h"
#include "common/sensor/camera_image.h"

namespace chorus::testing {

/// Projects a point by Brown's lens model, or by OpenCV's fisheye.  The camera's axes are OpenCV's:
/// x right, y down, z forward.
[[nodiscard]] Eigen::Vector2d projected(const Eigen::Vector3d& x_in_camera,
                                        const Intrinsics& camera);

struct PoseWishes {
  std::size_t count = 20;
  double share = 0.5;  ///< Share of the picture's width that the board takes.
  double tilt = 0.6;   ///< Largest tilt [rad].
  /// Largest distance of the board's centre from the picture's, as a share of its sides.
  double reach = 0.3;
  std::uint64_t seed = 1;
};

/// Poses of the board: camera_from_board, for the board's axes of black_parts() (x right, y up, z
/// towards the viewer) [m].
[[nodiscard]] std::vector<Eigen::Isometry3d> board_poses(const calibration::Board& board,
                                                         const Intrinsics& camera,
                                                         const PoseWishes& wishes);

/// The inner corners that lie in the picture, with Gaussian noise of `noise` [px] along each axis.
[[nodiscard]] calibration::View seen_corners(const calibration::Board& board,
                                             const Intrinsics& camera,
                                             const Eigen::Isometry3d& camera_from_board,
                                             double noise, std::uint64_t seed);

struct Flaws {
  double blur_px = 0.7;  ///< Standard deviation of a Gaussian.
  double noise = 4.0;    ///< Standard deviation of the grey values, which run from 0 to 255.
};

/// Renders pictures.  The constructor computes the ray of each subpixel once.
class BoardCamera {
 public:
  BoardCamera(const calibration::Board& board, const Intrinsics& camera);
  /// An 8-bit grey picture.
  [[nodiscard]] cv::Mat picture(const Eigen::Isometry3d& camera_from_board, const Flaws& flaws,
                                std::uint64_t seed) const;

 private:
  calibration::Board board_;
  Intrinsics camera_;
  cv::Mat sheet_;  ///< The board from the front, with its margin.
  cv::Mat rays_;   ///< x/z and y/z of each subpixel's ray.
};

}  // namespace chorus::testing
