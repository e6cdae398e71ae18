// Reads pictures from a webcam, a stream or a file: the only code that uses OpenCV's videoio.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "services/sensor/device/camera/file_pace.h"
#include "services/sensor/device/camera/picture.h"

namespace chorus::camera {

struct VideoMoment {
  /// For a webcam: time since the driver stamped the picture.  For streams and files: time since
  /// the beginning.
  std::optional<Duration> time;
};

class Video {
 public:
  virtual ~Video() = default;
  /// Waits for the next picture, at most a few seconds; none at the end of a file.
  [[nodiscard]] virtual Result<std::optional<VideoMoment>> next() = 0;
  /// The picture that next() found; converting it to pixels costs about half as much as decoding
  /// it.
  [[nodiscard]] virtual Result<Picture> picture() = 0;
  /// The times of a file's pictures; only for files.
  [[nodiscard]] virtual FileTiming timing() const = 0;
  /// For files only: continues near this position.
  virtual void skip_to(Duration position) = 0;
};

/// Why this webcam or file cannot be opened for reading, and what to do; empty if it can, and for
/// streams.  Does not disturb another program that uses the webcam.
[[nodiscard]] std::string why_closed(const CameraSettings& settings);

/// Opens the source.  An error says what is wrong and what to do.
[[nodiscard]] Result<std::unique_ptr<Video>> open_video(const CameraSettings& settings);

}  // namespace chorus::camera
