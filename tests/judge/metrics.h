// How good one person's fused bodies are, compared with the truth instant by instant.
//
// In metres, seconds and fractions; NaN when there was nothing to measure.  Only joints that were
// seen have errors; unseen ones show in coverage().
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/body/skeleton.h"
#include "common/time/timestamp.h"

namespace chorus::bench {

/// One instant: the body that a method reports for a person, and the truth at the time that the
/// method states.
struct Answer {
  Timestamp instant;
  Skeleton<WorldSpace> body;  ///< No joint is seen: the method reported nothing.
  Skeleton<WorldSpace> exact;
  std::array<std::size_t, kJointCount> views{};  ///< Number of views that saw each joint.
};

/// All instants of one person, in order of time.
using Answers = std::vector<Answer>;

enum class JointGroup {
  All,
  Centre,       ///< Spine, neck, head, shoulders, hips.
  Extremities,  ///< The rest: from elbows and knees outwards.
};

[[nodiscard]] bool belongs(JointId joint, JointGroup group);

/// Mean distance of a joint from its true position.
[[nodiscard]] double mpjpe(const Answers& answers, JointGroup group);

/// Like mpjpe(), after subtracting each joint's mean offset in the body's own frame: the error that
/// remains if only the definitions of joints differ.
[[nodiscard]] double bias_free_mpjpe(const Answers& answers, JointGroup group);

/// Mean distance between a joint's reported step and its true one [m], over joints that are truly
/// at rest.
[[nodiscard]] double jitter_at_rest(const Answers& answers, JointGroup group);

/// Standard deviation of a bone's length divided by its mean; averaged over upper arms, forearms,
/// thighs and shanks.
[[nodiscard]] double bone_variation(const Answers& answers);

/// Steps of a joint more than 80 mm longer than the true one, per minute, over all joints.
[[nodiscard]] double jumps_per_minute(const Answers& answers);

/// Fraction of the instants whose body fits the truth better with left and right swapped.
[[nodiscard]] double label_error_share(const Answers& answers);

/// Delay of the reported bodies against the truth [s]: the shift at which their velocities
/// correlate best, between -0.2 and 0.4 s; requires a moving person and equidistant instants.
[[nodiscard]] double latency(const Answers& answers);

/// Fraction of all joints at all instants that are reported.
[[nodiscard]] double coverage(const Answers& answers);

}  // namespace chorus::bench
