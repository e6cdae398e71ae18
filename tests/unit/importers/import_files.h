// Files for importer tests: written to a temporary folder, shipped, or shared.
#pragma once

#include <cstdlib>
#include <filesystem>

#include "tests/support/temporary_folder.h"

namespace chorus::importers {

/// The tests run in the repository root.
inline const std::filesystem::path kShippedRecordings = "tests/data";

/// $CHORUS_SHARED/data or ../shared/data: recordings that may not be distributed with the project.
inline std::filesystem::path shared_recordings() {
  const char* named = std::getenv("CHORUS_SHARED");
  return std::filesystem::path(named != nullptr ? named : "../shared") / "data";
}

using chorus::testing::bytes_of;
using chorus::testing::TemporaryFolder;

}  // namespace chorus::importers
