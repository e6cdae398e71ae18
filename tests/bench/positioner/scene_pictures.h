// Pictures of a person before clutter, for judging: the body is not the method's.
//
// Limbs are rings of points with muscles and loose clothes, the trunk is twice as broad as deep,
// shoes are boxes; all are meshes of quads, projected and filled.  common/silhouette knows tapered
// capsules with other radii, and no file is shared.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "common/body/skeleton.h"
#include "common/sensor/camera_image.h"

namespace cv {
class Mat;
}

namespace chorus::bench {

struct ScenePerson {
  Skeleton<WorldSpace> body;
  double girth = 1.0;
  int shade = 40;  ///< Of the clothes, of 255.
};

/// Something between the person and the camera, in shares of the picture's width and height.
struct SceneCover {
  double left = 0.0;
  double top = 0.0;
  double right = 1.0;
  double bottom = 1.0;
};

struct SceneLight {
  double lamp = 0.0;    ///< Added to the left third of the picture, of 255.
  double shadow = 0.0;  ///< Share of light that people take from the floor beside them.
  bool chair_moved = false;
};

struct ScenePicture {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  Intrinsics lens;
  std::vector<ScenePerson> people = {};
  std::optional<SceneCover> cover = {};
  SceneLight light = {};
  std::uint64_t seed = 1;  ///< Of the noise; the clutter is always the same.
};

/// Grey, 8 bits.
[[nodiscard]] cv::Mat picture_of(const ScenePicture& scene);

}  // namespace chorus::bench
