// The walks that come with Chorus: subject 2 of the CMU motion capture library (credit in NOTICE),
// built into the program, so that no files are needed at run time.
#pragma once

#include <vector>

#include "common/motion/asf_amc.h"

namespace chorus::motion {

struct CmuWalk {
  AsfSkeleton skeleton;
  std::vector<std::vector<AmcFrame>> takes;  ///< Takes 02_01 and 02_02; both are walks.
};

/// Parsed once, at first use.  A test parses the files, so this cannot fail at run time.
[[nodiscard]] const CmuWalk& cmu_walk();

}  // namespace chorus::motion
