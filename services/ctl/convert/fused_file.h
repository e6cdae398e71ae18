// Writes fused frames to a file as they come: a recording (.mcap), or lines of JSON.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/resource/frame_resource.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/snapshot.h"

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

/// Lines of JSON alone, under the rules of FusedFile.
class FrameLines {
 public:
  [[nodiscard]] static Result<FrameLines> create(const std::string& file);
  FrameLines(FrameLines&&) noexcept;
  ~FrameLines();

  [[nodiscard]] Result<void> add(const resource::FrameResource& frame);
  [[nodiscard]] Result<void> finish();

 private:
  class Impl;
  explicit FrameLines(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::ctl
