// The free space that recordings leave on a disk.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/base/result.h"

namespace chorus::record {

/// Unavailable when fewer than `wanted` bytes are free where the folder is ("": the current one);
/// Io when that cannot be asked.
[[nodiscard]] Result<void> enough_space(const std::filesystem::path& folder, std::uintmax_t wanted);

}  // namespace chorus::record
