// Captured motion (BVH, ASF/AMC, C3D, MVNX), prepared to be the truth for simulated people.
//
// A simulated person has all 25 joints at every instant: gaps are filled, and joints that the file
// lacks are derived from the others.  A T-pose before the motion is left out.  Paths, turns and
// speeds stay as captured.
#pragma once

#include <filesystem>
#include <vector>

#include "common/base/result.h"
#include "common/motion/motion.h"

namespace chorus::synthetic {

/// People captured together: at least one, all with one rate and length, every joint tracked.
/// The floor is y = 0; the origin is under the middle of the paths of their pelvises.
struct Performance {
  std::vector<motion::Motion> roles;
};

struct MotionFile {
  std::filesystem::path path;
  double metres_per_unit = 0.01;  ///< For BVH files, which do not state it; usually cm.
};

/// Chooses by the extension: .bvh, .amc, .c3d or .mvnx.  The skeleton of X_01.amc is X_01.asf or
/// X.asf in the same folder.
[[nodiscard]] Result<Performance> read_performance(const MotionFile& file);

/// Refuses people without hips, knees, ankles, shoulders, elbows or wrists, thighs of inhuman
/// length, and more frames than the limit for memory.
[[nodiscard]] Result<Performance> staged(std::vector<motion::Motion> captured);

/// 16 minutes at 120 Hz, 200 MB per person.
inline constexpr std::size_t kMaxMotionFrames = 120'000;

}  // namespace chorus::synthetic
