// Pictures out of a webcam, a stream or a file: the only code that uses OpenCV's videoio.
#pragma once

#include <memory>
#include <optional>

#include "services/sensor/device/camera/file_pace.h"
#include "services/sensor/device/camera/picture.h"

namespace chorus::camera {

struct VideoMoment {
  /// Of a webcam: how long ago the driver stamped it.  Of streams and files: since their beginning.
  std::optional<Duration> time;
};

class Video {
 public:
  virtual ~Video() = default;
  /// Blocks for the next picture, some seconds at most; nothing at the end of a file.
  [[nodiscard]] virtual Result<std::optional<VideoMoment>> next() = 0;
  /// That picture: turning it into pixels costs about half as much as decoding it.
  [[nodiscard]] virtual Result<Picture> picture() = 0;
  /// Of a file.
  [[nodiscard]] virtual FileTiming timing() const = 0;
  /// Of a file: goes on near that place.
  virtual void skip_to(Duration position) = 0;
};

/// Opens the source.  Errors say what is wrong with it, and what to do.
[[nodiscard]] Result<std::unique_ptr<Video>> open_video(const CameraSettings& settings);

}  // namespace chorus::camera
