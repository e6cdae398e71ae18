// Finds the number of the picture that a file describes, from the digits in the names of a folder's
// files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace chorus::importers {

struct PictureNumbers {
  std::vector<std::uint64_t> numbers;  ///< One for each name.
  /// The order of the names contradicted their numbers, so that their order counts.
  bool by_order = false;
};

/// A number for each name (without file extension).  For names that differ only in digits it is the
/// last run of digits that no two of them share ("cam_000012_pose2d" -> 12, not 2).  If there is no
/// such run, or for a name like no other, it is the longest run.  A name without a run of 1 to 12
/// digits gets its index in the list.
///
/// Where these numbers go back although the digits before them go on, as the milliseconds of
/// "12-30-00-990" and "12-30-01-023" do, they are no numbers of pictures: each name gets its place
/// in the order of all its digits.
[[nodiscard]] PictureNumbers picture_numbers(const std::vector<std::string>& names);

}  // namespace chorus::importers
