// A runner that is ready, and what it finds in pictures.
#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "services/sensor/device/camera/picture.h"
#include "services/sensor/device/camera/runner_process.h"
#include "services/sensor/device/camera/runner_wire.h"

namespace chorus::camera {

struct Found {
  std::vector<BodyFrame> bodies;
  Lens lens;                        ///< Of the picture.
  Size sent;                        ///< As the runner got it.
  std::optional<FloorPlane> floor;  ///< As the runner says, or as configured.
};

/// Not thread-safe; refers to its settings.
class Looker {
 public:
  /// Starts the command and hears what it is.
  [[nodiscard]] static Result<Looker> start(const CameraSettings& settings,
                                            const std::vector<std::string>& command,
                                            const std::stop_token& stop);

  /// One picture to the runner, and its answer.
  [[nodiscard]] Result<Found> look(const Picture& picture, Timestamp captured,
                                   std::uint64_t sequence, const std::stop_token& stop);
  [[nodiscard]] const RunnerHello& about() const { return about_; }
  /// Reads what it has to say to people; Unavailable when it has ended.
  [[nodiscard]] Result<void> listen() { return process_->listen(); }

 private:
  Looker(const CameraSettings& settings, std::unique_ptr<RunnerProcess> process, RunnerHello about)
      : settings_(&settings), process_(std::move(process)), about_(std::move(about)) {}

  const CameraSettings* settings_;
  std::unique_ptr<RunnerProcess> process_;
  RunnerHello about_;
};

}  // namespace chorus::camera
