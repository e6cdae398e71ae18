// The section device.camera of the configuration.
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
  Stream,  ///< rtsp://..., http://...: anything with a scheme.
  File,
};

struct CameraSettings {
  std::string source = "/dev/video0";
  std::string label = {};  ///< For people; empty: the source.
  int width = 0;           ///< For a webcam [px]; 0: its own choice (also height and rate).
  int height = 0;
  double rate_hz = 0.0;
  bool loop = true;  ///< A file starts again at its end.
  /// From light to arrival, if no clock of the camera tells.
  Duration latency = std::chrono::milliseconds(60);
  double max_rate_hz = 30.0;             ///< Most images per second that the runner gets.
  std::vector<std::string> runner{};     ///< The command; empty: the runner that comes with Chorus.
  std::string model = "movenet";         ///< Passed to the runner as --model; empty: not passed.
  bool depth_from_size = false;          ///< Points instead of rays, if the runner supports it.
  std::optional<FloorPlane> floor = {};  ///< From height and pitch, if they are configured.
  std::optional<Intrinsics> intrinsics = {};
  double focal_sigma = 0.0;  ///< Standard deviation of their focal length, relative to it.
  double fov = deg(65.0);    ///< Across the image's longer side [rad], if nothing better is known.
  double fov_sigma = deg(6.0);  ///< Standard deviation of that value [rad].
};

[[nodiscard]] SourceKind kind_of(const std::string& source);
/// The source in the form that people may read: without the password in a URL.
[[nodiscard]] std::string told_source(const std::string& source);

/// The reader's finish() reports mistakes.
[[nodiscard]] CameraSettings read_camera_settings(ConfigReader& section);

}  // namespace chorus::camera
