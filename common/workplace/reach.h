// Whether a hand gets to a point: with the arm alone, and leaning from the hips.
//
// The arm reaches as far as upper arm, forearm and hand are long (what is seen of them now, or what
// fusion has learned); leaning, the shoulder may be anywhere on a sphere about the middle of the
// hips.  The feet stay.  Errors of joints are taken as independent, as fusion states them.
#pragma once

#include <array>
#include <string>

#include "common/body/skeleton.h"
#include "common/body/stature.h"
#include "common/workplace/scene.h"

namespace chorus::workplace {

/// From the wrist, or from the hand joint, to where the hand grips [m]; the hand joint lies in the
/// palm.
inline constexpr double kGripBeyondWrist = 0.08;

struct Within {
  double missing = 0.0;      ///< How far the hand falls short [m]; negative: so much is to spare.
  double sigma = 0.0;        ///< Standard deviation of `missing` [m].
  double probability = 0.0;  ///< That it gets there, by the lengths and places alone.
};

struct Reach {
  bool known = false;        ///< False: shoulder, elbow, wrist or hips are not seen.
  double distance = 0.0;     ///< From the wrist now [m].
  Within arm;                ///< With the arm alone.
  Within leaning;            ///< Leaning from the hips.
  std::string blocked_by{};  ///< The obstacle between shoulder and point; empty: none.
};

struct Arm {
  const Skeleton<WorldSpace>& body;
  bool left = false;
  /// What fusion has learned of the person's build; null: what is seen now.
  const BoneLengthOf* bones = nullptr;
};

[[nodiscard]] Reach reach_of(const Arm& arm, const Eigen::Vector3d& point, const Scene& scene);

}  // namespace chorus::workplace
