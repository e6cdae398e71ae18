// One joint in one view, and the joint fused from several views.
#pragma once

#include <cstdint>
#include <vector>

#include "common/body/skeleton.h"
#include "fusion-server/flow.h"
#include "fusion-server/fusion/error_model.h"

namespace chorus::fusion {

/// A joint in one view, in world space.  Rays have no place and are left out.
struct JointView {
  Joint joint;
  double weight = 0.0;                                       ///< Of the view, Eqs. (1)-(3); >= 0.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< By the error model [m^2].
  std::uint64_t contributor = 0;  ///< The sensor's bit in FusedBody::contributors.
};

struct FusedJoint {
  Joint joint;  ///< NotTracked with zero position when nothing could be fused; with its covariance.
  double variance = 0.0;  ///< Mean per-axis variance [m^2].
  std::uint64_t contributors = 0;
};

/// One joint in all views of a person.  Weights that are NaN become zero.
[[nodiscard]] std::vector<JointView> joint_views_of(JointId joint, const Person& person,
                                                    const std::vector<SensorId>& sensors,
                                                    const ErrorModel& errors);

/// Sets a fused joint's covariance, and the mean variance that follows from it.
void state_covariance(FusedJoint& fused, const Eigen::Matrix3d& covariance);

/// Mean variance per axis [m^2].
[[nodiscard]] double mean_variance(const Eigen::Matrix3d& covariance);

}  // namespace chorus::fusion
