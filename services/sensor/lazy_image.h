// An image of one capture.  It is encoded once, ahead of time or for the first client that asks,
// and then kept.
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

  /// Encodes on the first call; an encoder's exception becomes an Error.
  [[nodiscard]] const Result<CameraImage>& get() const;

 private:
  mutable std::once_flag once_;
  /// Emptied after use, to free what it captured.
  mutable std::function<Result<CameraImage>()> encode_;
  mutable Result<CameraImage> image_;
};

}  // namespace chorus::sensor_service
