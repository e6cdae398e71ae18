// The messages between the sensor and a runner (proto/runner.md).  No IO.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/sensor/device/bridge/push_message.h"
#include "services/sensor/device/camera/lens.h"

namespace chorus::camera {

/// What a runner says about itself.
struct RunnerHello {
  bridge::Hello hello;  ///< Does not contain the camera, which only the sensor knows.
  int max_side = 640;   ///< Largest width and height of an image [px].
  bool masks = false;   ///< Whether it gives masks of people.
};

/// Which pixels are a person's: cells that cover the picture evenly, 255 or 0, row by row.
struct PersonMask {
  Size size;
  std::vector<std::uint8_t> cells;
};

/// An image on its way to the runner.
struct Question {
  std::uint64_t sequence = 0;
  Timestamp captured;
  Size size;          ///< Size in which it is sent.
  bool mask = false;  ///< Whether a mask of the person is wanted.
};

[[nodiscard]] Result<RunnerHello> read_runner_hello(std::string_view line);

/// The line that precedes an image's bytes, including its line feed.
[[nodiscard]] std::string image_header(const Question& question);

/// The people in the image of `question`, and the shapes that the runner states. `hello.camera` is
/// the camera of the image in the size sent.
[[nodiscard]] Result<bridge::PushedFrame> read_runner_answer(std::string_view line,
                                                             const Question& question,
                                                             const bridge::Hello& hello);

/// The mask in an answer; none if it has none.
[[nodiscard]] Result<std::optional<PersonMask>> read_runner_mask(std::string_view line);

}  // namespace chorus::camera
