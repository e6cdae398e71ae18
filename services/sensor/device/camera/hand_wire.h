// The messages between a program and a runner that finds hands (proto/runner.md, section 5).  No
// IO.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/hand/hand.h"
#include "services/sensor/device/camera/runner_wire.h"

namespace chorus::camera {

struct HandRunnerHello {
  std::string name;
  int max_side = 640;  ///< Largest width and height of an image [px].
};

/// Unsupported for a runner that finds no hands: one of version 1, or one whose "gives" lacks them.
[[nodiscard]] Result<HandRunnerHello> read_hand_hello(std::string_view line);

/// The hands in the image of `question`, in its pixels.
[[nodiscard]] Result<std::vector<hand::SeenHand>> read_hand_answer(std::string_view line,
                                                                   const Question& question);

}  // namespace chorus::camera
