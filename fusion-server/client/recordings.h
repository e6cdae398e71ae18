// Finds the recordings that a command line names; a folder stands for its .mcap files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/record/cell_reader.h"

namespace chorus::client {

/// The files that are named, and those in the folders that are named, sorted by name within each
/// folder.  Errors: an input does not exist or cannot be read, or there is no file.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_recordings(
    const std::vector<std::filesystem::path>& inputs);

/// One line for each thing that reading left out: damage first, then notes per sensor.
[[nodiscard]] std::vector<std::string> notes_of(const record::CellRecording& cell);

}  // namespace chorus::client
