// What kind of file somebody named, and what to do with it: asked whenever a reader fails.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "common/base/result.h"

namespace chorus::record {

struct Sniffed {
  std::string format;  ///< Of `chorus import`, or "recording"; empty if none reads it.
  std::string what;    ///< "a video (MP4)"; empty if it is not known.
  std::string remedy;  ///< "chorus import video reads it"; empty if there is none to name.
};

/// Looks at the beginning of a file, or at the files of a folder.  Never fails: what cannot be read
/// is unknown.  Of recordings (MCAP) the channels and the compression are told.
[[nodiscard]] Sniffed sniff(const std::filesystem::path& path);

/// The same for the beginning of a file that is no recording.
[[nodiscard]] Sniffed sniff_bytes(std::string_view bytes);

/// The error with what the first of the inputs is that is not `expected`, and what to do; unchanged
/// if all are as expected, or unknown.
[[nodiscard]] Error with_sniffed(Error error, std::span<const std::filesystem::path> inputs,
                                 std::string_view expected);

}  // namespace chorus::record
