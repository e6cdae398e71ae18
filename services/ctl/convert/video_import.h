// Turns videos into recordings: a runner processes every picture, however long that takes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/importers/formats.h"
#include "services/sensor/device/camera/runner_wire.h"

namespace chorus::ctl {

struct VideoImport {
  /// Files with the keys of device.camera.intrinsics, or configurations of sensors: one for all
  /// videos, or one for each.  If there is none, a usual field of view is assumed.
  std::vector<std::string> lenses;
  std::string model;
  double rate_hz = 30.0;  ///< Highest number of pictures per second.
  /// Called with the masks of people, if the runner gives any; from one thread.
  std::function<void(const SensorId& sensor, Timestamp captured, camera::PersonMask mask)> mask =
      {};
};

/// Each input is one camera, named after its file; all videos begin at options.start.  Reports the
/// progress on standard error.
[[nodiscard]] Result<importers::ImportedSet> import_videos(
    const std::vector<std::filesystem::path>& inputs, const importers::ImportOptions& options,
    const VideoImport& how);

}  // namespace chorus::ctl
