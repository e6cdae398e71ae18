// What one live camera's pictures show of the outline of the person.
#pragma once

#include <functional>
#include <memory>

#include "common/positioning/picture_sight.h"
#include "common/sensor/camera_image.h"
#include "services/sensor/device/camera/camera.h"

namespace chorus::positioner {

enum class EyeBackground {
  Auto,      ///< The network's mask if it gives one, else mixtures.
  Network,   ///< The network's mask only.
  Mixtures,  ///< What differs from the room, which is learned while nobody is found in it.
};

struct EyeSettings {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  double stature = 1.75;  ///< Of the person [m].
  double girth = 1.0;     ///< Relative to a usual one.
  EyeBackground background = EyeBackground::Auto;
};

/// Used on the camera's thread; what drawn() returns may be called on any.
class PictureEye {
 public:
  virtual ~PictureEye() = default;
  /// None while the room is not known, and where nothing differs from it.
  [[nodiscard]] virtual std::shared_ptr<const positioning::PictureSight> see(
      const camera::LookedAt& looked) = 0;
  /// The last picture with the outline of a body, encoded when asked for.
  [[nodiscard]] virtual std::function<Result<CameraImage>()> drawn(
      const Skeleton<WorldSpace>& body) const = 0;
};

[[nodiscard]] std::unique_ptr<PictureEye> make_eye(EyeSettings settings);

}  // namespace chorus::positioner
