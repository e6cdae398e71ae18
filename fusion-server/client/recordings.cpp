#include "fusion-server/client/recordings.h"

#include <system_error>

namespace chorus::client {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> find_recordings(const std::vector<fs::path>& inputs) {
  std::vector<fs::path> all;
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (!fs::exists(input, ignored))
      return fail(ErrorCode::NotFound, input.string(), "there is no such file or folder.");
    const auto found = record::recording_files(input);
    if (!found) return pass(found);
    all.insert(all.end(), found->begin(), found->end());
  }
  if (all.empty()) return fail(ErrorCode::InvalidArgument, "recordings", "none were named.");
  return all;
}

std::vector<std::string> notes_of(const record::CellRecording& cell) {
  std::vector<std::string> notes = cell.damage;
  for (const auto& recording : cell.sensors) {
    const auto left_out = recording.notes.find("left_out");
    if (left_out != recording.notes.end())
      notes.push_back(recording.sensor.str() + ": left out " + left_out->second);
  }
  return notes;
}

}  // namespace chorus::client
