// Notices what a pusher probably does wrong although each of its messages could be right: nothing
// is refused for it, but the pusher is told.  No IO; not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "common/base/duration.h"
#include "services/sensor/device/bridge/push_message.h"

namespace chorus::bridge {

class PoseDoubts {
 public:
  /// Takes what is seen in one frame.  A doubt is raised when all bodies have given reason for it
  /// in every frame of two seconds, and lasts until one does not.  Frames without bodies change
  /// nothing.
  void look(const PushedFrame& frame, const Hello& hello, SteadyTime now);

  /// The doubt that was raised last and not returned yet; where, what is strange, what to do.
  [[nodiscard]] std::optional<Error> take_new();
  /// The doubt that lasts, human-readable; empty if there is none.
  [[nodiscard]] std::string lasting() const;

 private:
  struct Watched {
    std::optional<SteadyTime> since;
    bool raised = false;
  };
  static constexpr std::size_t kDoubts = 4;

  std::array<Watched, kDoubts> watched_;
  std::optional<Error> fresh_;
};

}  // namespace chorus::bridge
