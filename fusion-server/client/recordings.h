// Which recordings a command line means: folders stand for the .mcap files in them.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/record/session_reader.h"

namespace chorus::client {

/// Sorted by name within a folder; each given file as it is.  Nothing found is an error.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_recordings(
    const std::vector<std::filesystem::path>& inputs);

/// Read whole; refuses none at all, and two of the same sensor unless they are parts of one
/// recording.  What was damaged or left out is told on `notes`, unless that is null.
[[nodiscard]] Result<record::Session> read_recordings(
    const std::vector<std::filesystem::path>& files, std::ostream* notes);

/// What reading had to leave out, a line each: damage once, then by sensor.
[[nodiscard]] std::vector<std::string> notes_of(const record::Session& session);

}  // namespace chorus::client
