// All pictures of a video file, looked at one after the other: as long as that takes, none is left
// out.
#pragma once

#include <functional>

#include "services/sensor/device/camera/looker.h"

namespace chorus::camera {

struct Film {
  CameraSettings settings;  ///< Its source is the file; max_rate_hz bounds what is looked at.
  std::vector<std::string> command;  ///< Of the runner.
  SensorId sensor;
  Timestamp start;  ///< When its first picture was captured.
  /// Told after every picture: the share of the file that is over [0, 1].
  std::function<void(double share)> progress = {};
};

struct FilmFrames {
  std::vector<SensorFrame> frames;  ///< One for each picture; captured = received.
  std::string runner;               ///< Its name.
  std::string layout;
  Lens lens;
  std::size_t people = 0;  ///< Most of them in one picture.
};

/// An error names the file and what is wrong with it, or the runner.
[[nodiscard]] Result<FilmFrames> look_through(const Film& film, const std::stop_token& stop = {});

}  // namespace chorus::camera
