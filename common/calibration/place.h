// Where a camera stands, from sights of a board or of marks on the floor (Madaras et al. 3.3).
//
// The world is y up, in metres.  A board that lies has its origin (the lower left corner of its
// sheet) at the world's, its x axis along +x, and its upper edge towards -z; one that stands has x
// along +x and its upper edge up, and looks along +z.  The camera is given as a sensor: x to the
// left, y up, z ahead.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/calibration/view.h"
#include "common/sensor/camera_image.h"

namespace chorus::calibration {

enum class BoardStance { Lies, Stands };

struct PlaceQuestion {
  Intrinsics lens;           ///< Of the pictures in which the sights are.
  double focal_sigma = 0.0;  ///< Relative standard deviation of its focal length.
  /// The first one defines the world.  In others the board may have been moved on the floor.
  std::vector<View> sights;
  BoardStance stance = BoardStance::Lies;
  double board_height = 0.0;          ///< Of a standing board's lower edge above the floor [m].
  double pixel_sigma = 0.3;           ///< Of a corner or a mark, at least [px].
  std::optional<double> height = {};  ///< Of the camera above the floor, measured [m].
  double height_sigma = 0.02;         ///< [m]
  double largest_roll = 0.5;          ///< A camera that is turned more than this is excluded [rad].
};

struct CameraPlace {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  /// Of (rotation vector, position) in world axes [rad^2, rad m, m^2], focal length included.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Covariance of that with the relative focal length, and the latter's variance.
  Eigen::Matrix<double, 7, 7> with_focal = Eigen::Matrix<double, 7, 7>::Zero();
  double error_px = 0.0;   ///< Root mean square distance of corners from where they should be.
  std::size_t sights = 0;  ///< Number of sights used.
  double roll = 0.0;       ///< About the line of sight [rad].
  /// By how much the other solution of the plane fits worse [variances]; none: it was excluded by
  /// the floor or by gravity.
  std::optional<double> mirrored_worse = {};
};

/// Both solutions of each plane are solved (Collins and Bartoli, "Infinitesimal plane-based pose
/// estimation", 2014); the one that is under the floor, or turned over, is excluded.  All sights
/// are then solved together by Gauss-Newton with the focal length.  InvalidArgument: no sight has
/// four points, the points do not fit this lens (`what` says what else they could be), no solution
/// stands above the floor.  Conflict: both solutions remain and fit alike.
[[nodiscard]] Result<CameraPlace> place_of(const PlaceQuestion& question);

}  // namespace chorus::calibration
