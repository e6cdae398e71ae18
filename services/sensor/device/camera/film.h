// Runs all pictures of a video file through a runner, one after the other, without leaving any out,
// however long that takes.
#pragma once

#include <functional>

#include "services/sensor/device/camera/looker.h"

namespace chorus::camera {

struct Film {
  CameraSettings settings;  ///< Its source is the file; max_rate_hz limits the pictures used.
  std::vector<std::string> command;  ///< The command of the runner.
  SensorId sensor;
  Timestamp start;  ///< Capture time of its first picture.
  /// Called after every picture: the fraction of the file that is done, [0, 1].
  std::function<void(double share)> progress = {};
};

struct FilmFrames {
  std::vector<SensorFrame> frames;  ///< One per picture; captured = received.
  std::string runner;               ///< Its name.
  std::string layout;
  Lens lens;
  std::size_t people = 0;  ///< The most in one picture.
};

/// An error names the file and what is wrong with it, or the runner.
[[nodiscard]] Result<FilmFrames> look_through(const Film& film, const std::stop_token& stop = {});

}  // namespace chorus::camera
