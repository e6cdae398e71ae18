// The configuration section device.camera.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/duration.h"
#include "common/base/units.h"
#include "common/sensor/camera_image.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::camera {

/// The kind of source that device.camera.source names.
enum class SourceKind {
  Device,  ///< A webcam: /dev/video0.
  Stream,  ///< rtsp://..., http://...: everything with a scheme.
  File,
};

struct CameraSettings {
  std::string source = "/dev/video0";
  std::string label = {};  ///< Human-readable; empty: the source.
  /// Width that a webcam is asked for [px]; 0: its own choice (also for height and rate).
  int width = 0;
  int height = 0;
  double rate_hz = 0.0;
  bool loop = true;  ///< True: a file starts again at its end.
  /// Time from light to arrival, used if the camera has no clock that shows it.
  Duration latency = std::chrono::milliseconds(60);
  double max_rate_hz = 30.0;  ///< Largest number of pictures per second that the runner gets.
  std::vector<std::string> runner{};  ///< The command; empty: the runner that comes with Chorus.
  std::string model = "movenet";      ///< Passed to the runner as --model, unless empty.
  bool depth_from_size = false;  ///< Delivers points instead of rays, if the runner supports it.
  std::optional<FloorPlane> floor = {};  ///< Made from height and pitch, if they are configured.
  std::optional<Intrinsics> intrinsics = {};
  double focal_sigma = 0.0;  ///< Relative standard deviation of the focal length in `intrinsics`.
  /// Field of view across the picture's longer side [rad], used if nothing better is known.
  double fov = deg(65.0);
  double fov_sigma = deg(6.0);  ///< Standard deviation of that value [rad].
};

/// The source as it is opened: of a number, as programs that use OpenCV take it, that webcam
/// ("0" is /dev/video0).
[[nodiscard]] std::string meant_source(std::string source);
[[nodiscard]] SourceKind kind_of(const std::string& source);
/// The source in a form that may be shown: without the user name and the password in a URL.
[[nodiscard]] std::string told_source(const std::string& source);

/// Reads the section; the reader's finish() reports mistakes.
[[nodiscard]] CameraSettings read_camera_settings(ConfigReader& section);

}  // namespace chorus::camera
