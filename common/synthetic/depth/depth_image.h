// Depth images: rendered exactly from surfaces, then measured as a time-of-flight camera would.
//
// Sensor space, metres.  Sensor x runs to the sensor's left, image columns to its right:
// column = cx - f x / z, row = cy - f y / z.  The camera is a Kinect v2's (f = 366 px, 512 x 424)
// of which every fourth column and row is taken: 128 x 106.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/plane.h"
#include "common/synthetic/depth/surface.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/kinect/visibility.h"

namespace chorus::synthetic::depth {

struct DepthCamera {
  int width = 128;
  int height = 106;
  double focal = 366.0 / 4;  ///< [px]
  double cx = 63.5;
  double cy = 52.5;

  /// The ray through the middle of a pixel, with z = 1.
  [[nodiscard]] Eigen::Vector3d ray(int column, int row) const {
    return {-(column - cx) / focal, -(row - cy) / focal, 1.0};
  }
  /// The pixel that sees the point; false outside the image or behind the camera.
  [[nodiscard]] bool see(const Eigen::Vector3d& point, int& column, int& row) const;
};

/// Row by row.  Where there is no depth, measured images have 0 and exact ones infinity.
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<float> depth;  ///< Along z [m]
  std::vector<bool> dark;    ///< True on dark cloth or hair; only in exact images.

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] double at(int column, int row) const {
    return static_cast<double>(depth[index(column, row)]);
  }
};

/// Everything that can be seen, in the space of the sensor.
struct View {
  std::vector<Taper> people;
  std::vector<kinect::Box> boxes;
  Plane floor;
};

/// Distance along the unit ray to the box; none when it misses or the origin is inside.
[[nodiscard]] std::optional<double> hit(const kinect::Box& box, const Eigen::Vector3d& ray);

[[nodiscard]] DepthImage render(const View& view, const DepthCamera& camera);

/// Applies the limits of range, noise, flying pixels and holes to an exact image.
[[nodiscard]] DepthImage measure(const DepthImage& exact, const TimeOfFlight& camera, Draw draw);

}  // namespace chorus::synthetic::depth
