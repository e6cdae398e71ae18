// An image of one capture, encoded once, ahead of time or by the first client that asks, and then
// kept.
#pragma once

#include <functional>
#include <mutex>

#include "common/base/result.h"
#include "common/sensor/camera_image.h"

namespace chorus::sensor_service {

/// Thread-safe.
class LazyImage {
 public:
  explicit LazyImage(std::function<Result<CameraImage>()> encode);

  /// Encodes on the first call; exceptions of the encoder become an Error.
  [[nodiscard]] const Result<CameraImage>& get() const;

 private:
  mutable std::once_flag once_;
  /// Emptied after use: frees what it holds.
  mutable std::function<Result<CameraImage>()> encode_;
  mutable Result<CameraImage> image_;
};

}  // namespace chorus::sensor_service
