// Which picture a file is of, by the digits in the names of a folder's files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace chorus::importers {

/// A number for each name without its ending.  Of names that differ in digits only it is the last
/// run of digits that no two of them share ("cam_000012_pose2d" -> 12, not 2); of a name like no
/// other it is the longest run.  A name without a run of 1 to 12 digits has its place in the list.
[[nodiscard]] std::vector<std::uint64_t> picture_numbers(const std::vector<std::string>& names);

}  // namespace chorus::importers
