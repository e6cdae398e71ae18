// From a depth image to points that are neither floor nor stray, in connected pieces.
#pragma once

#include <vector>

#include "common/geometry/plane.h"
#include "common/synthetic/depth/depth_image.h"

namespace chorus::synthetic::depth {

struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Sensor space [m]
  double above_floor = 0.0;                            ///< [m]
  std::size_t piece = 0;
};

struct Foreground {
  std::vector<SurfacePoint> points;
  std::size_t pieces = 0;
};

/// Floor and everything close to it goes, pixels that float between two surfaces go; neighbouring
/// pixels of like depth form a piece.
[[nodiscard]] Foreground foreground_of(const DepthImage& image, const DepthCamera& camera,
                                       const Plane& floor);

}  // namespace chorus::synthetic::depth
