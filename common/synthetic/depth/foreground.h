// Turns a depth image into points that are neither floor nor stray, grouped into connected pieces.
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

/// Leaves out the floor, what is close to it, what is higher than a person reaches, and pixels that
/// float between two surfaces.  Neighbouring pixels of similar depth form a piece.
[[nodiscard]] Foreground foreground_of(const DepthImage& image, const DepthCamera& camera,
                                       const Plane& floor);

}  // namespace chorus::synthetic::depth
