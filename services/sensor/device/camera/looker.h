// A runner that is ready, and the people that it finds in pictures.
#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "common/sensor/body_placer.h"
#include "services/sensor/device/camera/picture.h"
#include "services/sensor/device/camera/runner_process.h"
#include "services/sensor/device/camera/runner_wire.h"

namespace chorus::camera {

struct Found {
  std::vector<BodyFrame> bodies;
  Lens lens;                        ///< The lens of the picture.
  Size sent;                        ///< Size in which the runner got the picture.
  std::optional<FloorPlane> floor;  ///< From the runner or, if it gives none, as configured.
  std::optional<bool> outside_picture = {};  ///< All landmarks are; none if nobody is seen.
  std::optional<PersonMask> mask = {};       ///< If it was wanted and the runner gives it.
};

/// Not thread-safe; keeps a reference to its settings.
class Looker {
 public:
  /// Starts the runner and waits for its hello.
  [[nodiscard]] static Result<Looker> start(const CameraSettings& settings,
                                            const std::vector<std::string>& command,
                                            const std::stop_token& stop);

  /// From now on, masks are asked for, if the runner gives them.
  void want_masks() { masks_ = about_.masks; }
  /// Sends one picture to the runner and returns its answer.
  [[nodiscard]] Result<Found> look(const Picture& picture, Timestamp captured,
                                   std::uint64_t sequence, const std::stop_token& stop);
  [[nodiscard]] const RunnerHello& about() const { return about_; }
  /// Reads the runner's standard error; Unavailable when the runner has ended.
  [[nodiscard]] Result<void> listen() { return process_->listen(); }

 private:
  Looker(const CameraSettings& settings, std::unique_ptr<RunnerProcess> process, RunnerHello about)
      : settings_(&settings), process_(std::move(process)), about_(std::move(about)) {}

  const CameraSettings* settings_;
  std::unique_ptr<RunnerProcess> process_;
  RunnerHello about_;
  bool masks_ = false;
  BodyPlacer placer_;
};

}  // namespace chorus::camera
