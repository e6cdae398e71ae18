// A runner that is ready, and the hands that it finds in pictures.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/sensor/device/camera/hand_wire.h"
#include "services/sensor/device/camera/picture.h"
#include "services/sensor/device/camera/runner_process.h"

namespace chorus::camera {

/// Not thread-safe.
class HandFinder {
 public:
  /// Starts the runner and waits for its hello.  NotFound when its program does not exist,
  /// Unavailable when it ends at once, as without its packages.
  [[nodiscard]] static Result<HandFinder> start(const std::vector<std::string>& command);

  /// The hands in a picture, in its pixels, the surest first.
  [[nodiscard]] Result<std::vector<hand::SeenHand>> look(const Picture& picture);
  [[nodiscard]] const std::string& name() const { return about_.name; }

 private:
  HandFinder(std::unique_ptr<RunnerProcess> process, HandRunnerHello about)
      : process_(std::move(process)), about_(std::move(about)) {}

  std::unique_ptr<RunnerProcess> process_;
  HandRunnerHello about_;
  std::uint64_t sequence_ = 0;
};

}  // namespace chorus::camera
