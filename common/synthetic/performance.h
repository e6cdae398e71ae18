// Captured motion (BVH, ASF/AMC, C3D, MVNX) made fit to be somebody's truth.
//
// A simulated person has all 25 joints at every instant: gaps are filled, joints that the file does
// not have are set where the others put them.  A T-pose before the motion is left out.  Paths,
// turns and speeds stay as captured.
#pragma once

#include <filesystem>
#include <vector>

#include "common/base/result.h"
#include "common/motion/motion.h"

namespace chorus::synthetic {

/// People captured together: at least one, all of one rate and length, every joint tracked.
/// y = 0 is the floor, the origin lies under the middle of where their pelvises go.
struct Performance {
  std::vector<motion::Motion> roles;
};

struct MotionFile {
  std::filesystem::path path;
  double metres_per_unit = 0.01;  ///< Of BVH lengths, which do not say; centimetres by custom.
};

/// By the ending: .bvh, .amc, .c3d or .mvnx.  The skeleton of X_01.amc is X_01.asf or X.asf beside
/// it.
[[nodiscard]] Result<Performance> read_performance(const MotionFile& file);

/// Refuses people without hips, knees, ankles, shoulders, elbows or wrists, thighs of no human
/// length, and more frames than memory should hold.
[[nodiscard]] Result<Performance> staged(std::vector<motion::Motion> captured);

/// 16 minutes at 120 Hz, 200 MB a person.
inline constexpr std::size_t kMaxMotionFrames = 120'000;

}  // namespace chorus::synthetic
