// Turns the output files of pose estimators into recordings of rays.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/importers/formats.h"

namespace chorus::ctl {

struct PoseImport {
  std::vector<std::string> lenses;  ///< One for all, or one for each (lens_file.h).
  double rate_hz = 30.0;            ///< Pictures per second.
};

/// Each input is one camera (pose_frames.h), named after its folder or file.
[[nodiscard]] Result<importers::ImportedSet> import_poses(
    const std::vector<std::filesystem::path>& inputs, const importers::ImportOptions& options,
    const PoseImport& how);

}  // namespace chorus::ctl
