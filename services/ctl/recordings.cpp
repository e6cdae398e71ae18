#include "services/ctl/recordings.h"

#include <algorithm>
#include <system_error>

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

Result<record::Session> read_recordings(const std::vector<fs::path>& files) {
  auto session = record::read_session(files);
  if (session && session->sensors.empty())
    return fail(ErrorCode::NotFound, files.front().string(),
                "holds no frames of a sensor; was it recorded with --fused alone?");
  return session;
}

}  // namespace chorus::ctl
