// Reads any bytes as index.json of a recording: a report or an Error, never a crash; a report names
// only files in its own folder, and after being written it reads as the same.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "common/record/recording_index.h"

namespace {

namespace fs = std::filesystem;

void require(bool holds) {
  if (!holds) std::abort();
}

/// A folder, in memory where possible, with one file that an index may name.
fs::path folder() {
  static const fs::path made = [] {
    const fs::path shared = fs::exists("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
    const fs::path path = shared / ("chorus-index-" + std::to_string(::getpid()));
    fs::create_directories(path);
    std::ofstream(path / "a.mcap") << "twelve bytes";
    static const struct Sweeper {
      fs::path path;
      ~Sweeper() { fs::remove_all(path); }
    } sweeper{path};
    return path;
  }();
  return made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fs::path path = folder();
  std::ofstream(path / chorus::record::kIndexFile, std::ios::binary)
      << std::string_view(reinterpret_cast<const char*>(bytes), size);
  const auto report = chorus::record::read_index(path);
  if (!report) {
    require(!report.error().message.empty());
    return 0;
  }
  for (const auto& file : report->files) require(fs::path(file.name).filename() == file.name);
  require(chorus::record::write_index(path, *report).has_value());
  const auto again = chorus::record::read_index(path);
  require(again && again->frames == report->frames && again->files.size() == report->files.size());
  require(again->bytes() == report->bytes() && again->started == report->started);
  return 0;
}
