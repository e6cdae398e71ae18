// One joint in one view, and the joint fused from several views.
#pragma once

#include <cstdint>
#include <vector>

#include "common/body/skeleton.h"
#include "fusion-server/flow.h"
#include "fusion-server/fusion/error_model.h"

namespace chorus::fusion {

/// A joint in one view, in world space: a point, or a ray from the view's eye.
struct JointView {
  Joint joint;
  double weight = 0.0;  ///< Of the view, Eqs. (1)-(3); >= 0.
  /// By the error model: of a point [m^2], of a ray's direction [rad^2].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  double pose_variance = 0.0;     ///< What it errs by beyond that, per axis [m^2] (pose_error.h).
  std::uint64_t contributor = 0;  ///< The sensor's bit in FusedBody::contributors.
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Where the sensor stands [m].
  std::size_t view = 0;                           ///< Its index in Person::views.
};

struct FusedJoint {
  Joint joint;  ///< NotTracked with zero position when nothing could be fused; with its covariance.
  double variance = 0.0;  ///< Mean per-axis variance [m^2].
  std::uint64_t contributors = 0;
};

/// One joint in all views of a person that have a place for it; rays are left out.  Weights that
/// are NaN become zero.
[[nodiscard]] std::vector<JointView> joint_views_of(JointId joint, const Person& person,
                                                    const std::vector<SensorId>& sensors,
                                                    const ErrorModel& errors);

/// The same with rays.
[[nodiscard]] std::vector<JointView> points_and_rays_of(JointId joint, const Person& person,
                                                        const std::vector<SensorId>& sensors,
                                                        const ErrorModel& errors);

/// Sets a fused joint's covariance, and the mean variance that follows from it.
void state_covariance(FusedJoint& fused, const Eigen::Matrix3d& covariance);

/// Mean variance per axis [m^2].
[[nodiscard]] double mean_variance(const Eigen::Matrix3d& covariance);

}  // namespace chorus::fusion
