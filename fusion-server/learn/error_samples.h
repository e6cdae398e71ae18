// What error predictors are fitted to: joints of single views, whose true places are known.
#pragma once

#include <vector>

#include "fusion-server/flow/person.h"
#include "fusion-server/fusion/joint_features.h"

namespace chorus::learn {

struct ErrorSample {
  JointId joint = JointId::SpineBase;
  fusion::Features features = {};
  double error = 0.0;  ///< Distance from the true joint [m].
};

/// Adds a sample for each point of each view if `exact` has that joint, too.  The views are those
/// that fusion gets: at the common instant, in world space, with left and right resolved.
void add_samples(const Person& person, const Skeleton<WorldSpace>& exact,
                 std::vector<ErrorSample>& samples);

}  // namespace chorus::learn
