#include "tests/bench/live/scratch_folder.h"

#include <cstdlib>
#include <utility>

namespace chorus::bench {

namespace fs = std::filesystem;

Result<ScratchFolder> ScratchFolder::make() {
  std::string name = (fs::temp_directory_path() / "chorus-bench-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    return fail(ErrorCode::Io, name, "cannot make a temporary folder");
  return ScratchFolder(name);
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace chorus::bench
