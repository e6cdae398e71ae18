// How good one person's fused bodies are, instant by instant beside the truth.
//
// Metres, seconds and shares inside; NaN when there was nothing to measure.  Only seen joints have
// errors; what was not seen shows in coverage().
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/body/skeleton.h"
#include "common/time/timestamp.h"

namespace chorus::bench {

/// One instant: what a method says of a person, at the time it states, and what is true then.
struct Answer {
  Timestamp instant;
  Skeleton<WorldSpace> body;  ///< Nothing seen: the method had no answer.
  Skeleton<WorldSpace> exact;
  std::array<std::size_t, kJointCount> views{};  ///< How many saw each joint.
};

/// In order of time.
using Answers = std::vector<Answer>;

enum class JointGroup {
  All,
  Centre,       ///< Spine, neck, head, shoulders, hips.
  Extremities,  ///< The rest: elbows and knees outwards.
};

[[nodiscard]] bool belongs(JointId joint, JointGroup group);

/// Mean distance of a joint from where it is.
[[nodiscard]] double mpjpe(const Answers& answers, JointGroup group);

/// The same after each joint's mean offset in the body's own frame is taken off: what is left when
/// only the definition of a joint differs.
[[nodiscard]] double bias_free_mpjpe(const Answers& answers, JointGroup group);

/// Mean step beyond the true one from instant to instant [m], over joints that truly rest.
[[nodiscard]] double jitter_at_rest(const Answers& answers, JointGroup group);

/// Standard deviation of a bone's length over its mean; mean over upper arms, forearms, thighs and
/// shanks.
[[nodiscard]] double bone_variation(const Answers& answers);

/// Steps of a joint more than 80 mm longer than the true one, per minute, over all joints.
[[nodiscard]] double jumps_per_minute(const Answers& answers);

/// Share of the instants whose body fits the truth better with left and right exchanged.
[[nodiscard]] double label_error_share(const Answers& answers);

/// How far the answers lag behind the truth [s]: the shift at which their velocities correlate
/// best, between -0.2 and 0.4 s; needs a person who moves and instants at a steady rate.
[[nodiscard]] double latency(const Answers& answers);

/// Share of all joints of all instants that were answered.
[[nodiscard]] double coverage(const Answers& answers);

}  // namespace chorus::bench
