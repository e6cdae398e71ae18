// Which recordings a command line names: a folder stands for the .mcap files in it.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/record/cell_reader.h"

namespace chorus::client {

/// Sorted by name within a folder; each given file as it is.  Nothing found is an error.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_recordings(
    const std::vector<std::filesystem::path>& inputs);

/// Read whole.  Refuses an empty list, and two recordings of the same sensor unless they are parts
/// of one recording.  Damaged or omitted parts are reported on `notes`, unless that is null.
[[nodiscard]] Result<record::CellRecording> read_recordings(
    const std::vector<std::filesystem::path>& files, std::ostream* notes);

/// What reading had to leave out, one line each: damage once, then by sensor.
[[nodiscard]] std::vector<std::string> notes_of(const record::CellRecording& cell);

}  // namespace chorus::client
