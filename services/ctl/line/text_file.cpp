#include "services/ctl/line/text_file.h"

#include <algorithm>
#include <iostream>
#include <system_error>

#include "common/base/file.h"

namespace chorus::ctl {

namespace fs = std::filesystem;

Result<void> write_text(const std::string& file, std::string_view text) {
  if (file == "-") {
    std::cout << text << std::flush;
    if (std::cout) return {};
    return fail(ErrorCode::Io, "standard output", "cannot be written.");
  }
  std::error_code error;
  const fs::path folder = fs::path(file).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error))
    return fail(ErrorCode::Io, file, "cannot be written; is its folder there?");
  return replace_file(file, text);
}

Result<void> may_write(const std::string& file, const std::vector<fs::path>& inputs) {
  std::error_code error;
  if (file == "-" || !fs::is_regular_file(file, error)) return {};
  for (const fs::path& input : inputs) {
    if (fs::equivalent(file, input, error) && !error)
      return fail(ErrorCode::InvalidArgument, file,
                  "is what is read here; writing it would destroy it. Name another file.");
  }
  if (fs::path(file).extension() == ".mcap")
    return fail(ErrorCode::Conflict, file,
                "exists already, and a recording is never overwritten. Name another file.");
  return {};
}

bool same_file(const std::string& one, const std::string& other) {
  if (one.empty() || other.empty()) return false;
  if (one == "-" || other == "-") return one == other;
  std::error_code unknown;
  const fs::path a = fs::weakly_canonical(one, unknown);
  const fs::path b = fs::weakly_canonical(other, unknown);
  return !unknown && a == b;
}

Result<void> may_create(const std::string& file) {
  std::error_code unknown;
  if (file == "-" || !fs::exists(file, unknown)) return {};
  return fail(ErrorCode::Conflict, file,
              "exists already, and is not overwritten: move it away, or name another --out");
}

}  // namespace chorus::ctl
