// Where a sensor saw the person, how its frames come, and how much of them it guesses.
#pragma once

#include <array>

#include "common/characteristics/one_person.h"

namespace chorus::characteristics {

/// From the least to the most that was seen.
struct Extent {
  double least = 0.0;
  double most = 0.0;
};

/// Where joints were seen.  The sensor sees at least as far; it may see farther.
struct FieldOfView {
  /// Tracked joints: angles off the optical axis, to the sensor's left and upwards [rad].
  Extent aside, upwards;
  Extent guessed_aside, guessed_upwards;  ///< The same for inferred joints.
  Extent distance;                        ///< Of the trunk [m].
};

struct Delivery {
  double step = 0.0;         ///< Median time between frames [s].
  double step_sigma = 0.0;   ///< Standard deviation of that time, without gaps [s].
  double lost_share = 0.0;   ///< Share of frames missing in short gaps.
  double longest_gap = 0.0;  ///< [s]
  double empty_share = 0.0;  ///< Share of frames without the person.
};

struct JointShares {
  double inferred = 0.0;
  double missing = 0.0;
};

struct Coverage {
  FieldOfView view;
  Delivery delivery;
  std::array<JointShares, kJointCount> joints{};  ///< Shares of the frames with the person.
};

[[nodiscard]] Coverage coverage_of(const OnePerson& person);

}  // namespace chorus::characteristics
