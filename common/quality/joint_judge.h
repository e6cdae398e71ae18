// One joint of one person over time: coverage, gaps, noise and jumps.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "common/quality/fused_quality.h"

namespace chorus::quality {

/// Noise is the root mean square of differences of this order at rest, and in motion, by what white
/// noise of standard deviation 1 would give.  Higher orders leave less of the motion.
inline constexpr std::size_t kRestOrder = 2;
inline constexpr std::size_t kMotionOrder = 3;

/// What is counted of one joint, over all people.
struct JointCounts {
  std::size_t present = 0;
  std::size_t tracked = 0;
  std::size_t inferred = 0;
  std::size_t missing = 0;
  std::size_t unseen = 0;
  std::size_t carried = 0;
  std::size_t contributors = 0;
  int gaps = 0;
  int jumps = 0;
  double first_jump_at = 0.0;
  double longest_gap = 0.0;
  double longest_gap_at = 0.0;
  double rest_squares = 0.0;
  std::size_t rest = 0;
  double motion_squares = 0.0;
  std::size_t motion = 0;
  double stated_squares = 0.0;
  std::size_t stated = 0;

  [[nodiscard]] JointQuality quality() const;
};

/// The joint of one person; adds to the counts of all.
class JointJudge {
 public:
  /// `at` after the first frame [s]; `carried`: the person is out of sight.
  void add(const resource::JointResource& joint, double at, bool carried, JointCounts& counts);
  /// The person is not in the frame.
  void absent() { places_.clear(); }

 private:
  struct Place {
    double at;
    Eigen::Vector3d x_in_world;
  };

  void gap(bool missing, double at, JointCounts& counts);
  void motion(JointCounts& counts);

  std::vector<Place> places_;  ///< The last four, without a gap between them.
  bool missing_ = false;
  double missing_since_ = 0.0;
};

}  // namespace chorus::quality
