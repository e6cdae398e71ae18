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
  double rate_hz = 0.0;  ///< The highest; 0: not told.

  bool operator==(const WebcamMode&) const = default;
};

struct Webcam {
  std::string path;  ///< "/dev/video0"
  std::string name;  ///< "HD Pro Webcam C920"
  std::string bus;   ///< Where it is plugged in, to tell two of one kind apart.
  std::vector<WebcamMode> modes = {};
  std::string problem = {};  ///< Why it cannot be used; empty when it can.
};

/// All video devices below `folder` that take pictures, by number; one that cannot be opened comes
/// with its problem.
[[nodiscard]] std::vector<Webcam> webcams(const std::filesystem::path& folder);

/// For people: a table, or what to do when there are none.
[[nodiscard]] std::string webcam_report(const std::vector<Webcam>& cameras);

}  // namespace chorus::ctl
