// People over time from a motion file or from fused frames: what `compare` compares, and what
// `evaluate` takes as a reference.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/comparison/comparison.h"
#include "common/importers/motion_file.h"

namespace chorus::ctl {

struct ComparedSource {
  comparison::People people;
  std::vector<std::string> notes;  ///< What was salvaged.
};

/// By the file's ending: .c3d, .trc, .bvh, .htr, .mvnx; none for everything else.
[[nodiscard]] std::optional<importers::MotionFormat> motion_format(const std::string& file);

/// Times count from the options' start, or are those that the file states.
[[nodiscard]] Result<ComparedSource> read_motion(const std::string& file,
                                                 importers::MotionFormat format,
                                                 const importers::ImportOptions& options = {});

/// A motion file, or fused frames (a recording, lines of JSON, or a server that is listened to for
/// `seconds`).
[[nodiscard]] Result<ComparedSource> read_compared(const std::string& source, double seconds);

}  // namespace chorus::ctl
