// Captured motion (BVH, ASF/AMC, C3D, MVNX), prepared as the truth for simulated people.
//
// A simulated person has all 25 joints at every instant: gaps are filled, and joints that the file
// lacks are derived from others.  A T-pose before the motion is left out.  Paths, turns and speeds
// stay as captured.
#pragma once

#include <filesystem>
#include <vector>

#include "common/base/result.h"
#include "common/motion/motion.h"

namespace chorus::synthetic {

/// People who were captured together: at least one; all motions have the same rate and length, and
/// every joint is tracked.  The floor is y = 0; the origin is under the middle of the paths of the
/// pelvises.
struct Performance {
  std::vector<motion::Motion> roles;
};

struct MotionFile {
  std::filesystem::path path;
  double metres_per_unit = 0.01;  ///< For BVH files, which do not state it; usually centimetres.
};

/// Reads a file by its extension: .bvh, .amc, .c3d or .mvnx.  The skeleton of X_01.amc is X_01.asf
/// or X.asf in the same folder.
[[nodiscard]] Result<Performance> read_performance(const MotionFile& file);

/// Prepares captured motion.  People without hips, knees, ankles, shoulders, elbows or wrists are
/// left out if somebody else has them all, and otherwise refused.  Also refuses motion without
/// people or frames, with more than kMaxMotionFrames, with an unusable rate, or with thighs of
/// inhuman length.
[[nodiscard]] Result<Performance> staged(std::vector<motion::Motion> captured);

/// 16 minutes at 120 Hz, which need 200 MB per person.
inline constexpr std::size_t kMaxMotionFrames = 120'000;

}  // namespace chorus::synthetic
