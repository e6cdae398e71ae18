// Takes of suits from files: MVNX (Xsens MVN) and BVH (every other suit's program).
#pragma once

#include <filesystem>

#include "common/base/result.h"
#include "common/suit/suit_pose.h"

namespace chorus::suit {

struct SuitFileOptions {
  double stature = 0.0;           ///< Of the person [m]; 0: the file's own bones.
  double metres_per_unit = 0.01;  ///< Of BVH; MVNX is in metres.
};

/// Decides by the name's ending, .mvnx or .bvh; refuses others, and a person shorter than 0.5 m or
/// taller than 2.5 m, naming the unit that would fit.
[[nodiscard]] Result<SuitTake> read_suit_file(const std::filesystem::path& file,
                                              const SuitFileOptions& options = {});

}  // namespace chorus::suit
