// Finds the recordings that a command line names: a folder stands for its .mcap files.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/record/cell_reader.h"

namespace chorus::client {

/// Files in a folder are sorted by name; a given file is taken as it is.  None found: an error.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_recordings(
    const std::vector<std::filesystem::path>& inputs);

/// Reads the recordings whole.  Refuses an empty list, and two recordings of the same sensor unless
/// they are parts of one recording.  Reports damaged or omitted parts on `notes` unless it is null.
[[nodiscard]] Result<record::CellRecording> read_recordings(
    const std::vector<std::filesystem::path>& files, std::ostream* notes);

/// What was left out while reading, one line each: first damage, then notes per sensor.
[[nodiscard]] std::vector<std::string> notes_of(const record::CellRecording& cell);

}  // namespace chorus::client
