// What a scan found, as JSON: written by `chorus scan`, read by a glove's tracker.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/hand/hand.h"
#include "common/hand/skeleton.h"

namespace chorus::hand {

/// What stands in the file besides the skeleton.
struct ScanRecord {
  std::string source;         ///< The picture's name.
  std::string scale_from;     ///< "the file's 300 dpi"; "" if the scale is not known.
  double mm_per_pixel = 0.0;  ///< 0: not known.
  std::string network;        ///< Name of the network; "" without one.
};

[[nodiscard]] std::string scan_json(const HandShape& hand, const Skeleton& skeleton,
                                    const ScanRecord& record);

/// The skeleton in such a document; Malformed with the place of what is wrong.
[[nodiscard]] Result<Skeleton> read_skeleton(std::string_view json);

}  // namespace chorus::hand
