#include "common/record/recording_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "common/record/mcap_format.h"

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

using mcap::Op;

/// Reads `count` bytes from the file; fewer at its end.
std::string taken(std::istream& in, std::size_t count) {
  std::string bytes(count, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

/// The first log time of the first chunk or of the first message outside chunks, whichever comes
/// first.
std::optional<std::uint64_t> first_log_time(const fs::path& file) {
  constexpr std::size_t kBeforeTimeOfMessage = 2 + 4;  // channel and sequence
  constexpr std::size_t kTime = 8;
  std::error_code unknown;
  if (!fs::is_regular_file(file, unknown)) return std::nullopt;  // Opening a pipe would wait.
  std::ifstream in(file, std::ios::binary);
  if (taken(in, mcap::kMagic.size()) != mcap::kMagic) return std::nullopt;
  while (in) {
    const std::string head = taken(in, mcap::kRecordHead);
    mcap::ByteReader fields(head);
    const auto op = static_cast<Op>(fields.u8());
    const std::uint64_t length = fields.u64();
    if (!fields.ok() || op == Op::DataEnd || op == Op::Footer) break;
    if (op == Op::Chunk || op == Op::Message) {
      if (op == Op::Message) in.seekg(kBeforeTimeOfMessage, std::ios::cur);
      const std::string bytes = taken(in, kTime);
      mcap::ByteReader time(bytes);
      const std::uint64_t ns = time.u64();
      return time.ok() ? std::optional(ns) : std::nullopt;
    }
    if (length > static_cast<std::uint64_t>(std::numeric_limits<std::streamoff>::max())) break;
    in.seekg(static_cast<std::streamoff>(length), std::ios::cur);
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<fs::path>> recording_files(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return std::vector<fs::path>{path};
  std::vector<fs::path> files;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".mcap") files.push_back(it->path());
  }
  if (error) return fail(ErrorCode::Io, path.string(), error.message());
  if (files.empty()) {
    return fail(ErrorCode::NotFound, path.string(),
                "holds no .mcap recording; chorus record and chorus import make them");
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<std::vector<fs::path>> find_recordings(const std::vector<fs::path>& inputs) {
  std::vector<fs::path> all;
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (!fs::exists(input, ignored))
      return fail(ErrorCode::NotFound, input.string(), "there is no such file or folder.");
    const auto found = recording_files(input);
    if (!found) return pass(found);
    all.insert(all.end(), found->begin(), found->end());
  }
  if (all.empty()) return fail(ErrorCode::InvalidArgument, "recordings", "none were named.");
  return all;
}

std::vector<fs::path> in_log_order(std::vector<fs::path> files) {
  using Dated = std::pair<std::optional<std::uint64_t>, fs::path>;
  std::vector<Dated> dated;
  for (fs::path& file : files) {
    const auto first = first_log_time(file);
    dated.emplace_back(first, std::move(file));
  }
  std::stable_sort(dated.begin(), dated.end(),
                   [](const Dated& a, const Dated& b) { return a.first < b.first; });
  files.clear();
  for (Dated& one : dated) files.push_back(std::move(one.second));
  return files;
}

}  // namespace chorus::record
