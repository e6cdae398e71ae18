// The webcams of this host, as Video4Linux knows them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace chorus::ctl {

struct WebcamMode {
  std::string format;  ///< "MJPG", "YUYV"
  int width = 0;       ///< [px]
  int height = 0;
  double rate_hz = 0.0;  ///< The highest; 0: not reported.

  bool operator==(const WebcamMode&) const = default;
};

struct Webcam {
  std::string path;  ///< "/dev/video0"
  std::string name;  ///< "HD Pro Webcam C920"
  std::string bus;   ///< Where it is plugged in; distinguishes two cameras of the same model.
  std::vector<WebcamMode> modes = {};
  std::string problem = {};  ///< Why it cannot be used; empty when it can.
};

/// All video devices in `folder` that capture pictures, by number; a device that cannot be opened
/// is listed with its problem.
[[nodiscard]] std::vector<Webcam> webcams(const std::filesystem::path& folder);

/// Text for people: a table, or what to do when there are no cameras.
[[nodiscard]] std::string webcam_report(const std::vector<Webcam>& cameras);

}  // namespace chorus::ctl
