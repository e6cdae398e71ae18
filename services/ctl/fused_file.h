// Writes fused frames to a file as they come: a recording (.mcap), or lines of JSON.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.h"
#include "fusion-server/flow.h"

namespace chorus::ctl {

/// Only finish() puts the file in its place; without it, nothing is left behind. (Lines for a pipe
/// or a device are written at once.) An existing recording is not replaced (Conflict), other files
/// are. "-" is standard output. The contents do not depend on when or where they are written.
class FusedFile {
 public:
  virtual ~FusedFile() = default;

  [[nodiscard]] virtual Result<void> add(const Snapshot& snapshot) = 0;
  [[nodiscard]] virtual Result<void> finish() = 0;
};

[[nodiscard]] Result<std::unique_ptr<FusedFile>> create_fused_file(
    const std::string& file, const Registration& registration);

}  // namespace chorus::ctl
