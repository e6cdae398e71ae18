#include "services/ctl/recordings.h"

#include <algorithm>
#include <map>
#include <system_error>

#include <fmt/format.h>

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> recordings_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->path().extension() == ".mcap") found.push_back(it->path());
  }
  if (failed) return fail(ErrorCode::Io, folder.string(), failed.message());
  if (found.empty())
    return fail(ErrorCode::NotFound, folder.string(),
                "holds no .mcap recording; chorus import makes them.");
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

Result<std::vector<fs::path>> find_recordings(const std::vector<fs::path>& inputs) {
  std::vector<fs::path> all;
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (!fs::exists(input, ignored))
      return fail(ErrorCode::NotFound, input.string(), "there is no such file or folder.");
    if (!fs::is_directory(input, ignored)) {
      all.push_back(input);
      continue;
    }
    const auto found = recordings_in(input);
    if (!found) return pass(found);
    all.insert(all.end(), found->begin(), found->end());
  }
  if (all.empty()) return fail(ErrorCode::InvalidArgument, "recordings", "none were named.");
  return all;
}

Result<std::vector<record::FrameRecording>> read_recordings(const std::vector<fs::path>& files) {
  std::vector<record::FrameRecording> recordings;
  std::map<SensorId, fs::path> seen;
  for (const fs::path& file : files) {
    auto recording = record::read_frame_recording(file);
    if (!recording) return pass(recording);
    const auto [other, fresh] = seen.try_emplace(recording->sensor, file);
    if (!fresh)
      return fail(ErrorCode::Conflict, file.string(),
                  fmt::format("is a recording of sensor {}, and so is {}.", recording->sensor.str(),
                              other->second.string()));
    recordings.push_back(std::move(*recording));
  }
  return recordings;
}

}  // namespace chorus::ctl
