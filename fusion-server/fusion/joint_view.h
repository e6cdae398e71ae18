// One joint in one view, and the joint fused from several views.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/body/skeleton.h"
#include "common/sensor/shares.h"
#include "fusion-server/flow/person.h"
#include "fusion-server/fusion/error_model.h"

namespace chorus::fusion {

/// A joint in one view, in world space: a point, or a ray from the view's eye.
struct JointView {
  Joint joint;
  double weight = 0.0;  ///< Weight of the view, Eqs. (1)-(3); >= 0.
  /// The error model's covariance of a point's position [m^2], or of a ray's direction [rad^2].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  bool whole = false;  ///< The covariance contains the pose error, JointError::whole.
  /// Variance of its additional pose error, per axis [m^2] (pose_error.h).
  double pose_variance = 0.0;
  std::uint64_t contributor = 0;                  ///< The sensor's bit in FusedBody::contributors.
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Position of the sensor [m].
  std::size_t view = 0;                           ///< Its index in Person::views.
};

struct FusedJoint {
  Joint joint;  ///< With covariance; NotTracked at position zero when nothing could be fused.
  double variance = 0.0;  ///< Mean per-axis variance [m^2].
  std::uint64_t contributors = 0;
  /// Of the contributors: by how much each determines the position (decision 0075).
  Shares shares = {};
  double age = 0.0;  ///< Time since a sensor last contributed [s].
};

/// One joint in every view of a person that measured a point for it; rays are left out.  Weights
/// are limited to [0, 1]; NaN becomes zero.
[[nodiscard]] std::vector<JointView> joint_views_of(JointId joint, const Person& person,
                                                    const std::vector<SensorId>& sensors,
                                                    const ErrorModel& errors);

/// joint_views_of(), rays included.
[[nodiscard]] std::vector<JointView> points_and_rays_of(JointId joint, const Person& person,
                                                        const std::vector<SensorId>& sensors,
                                                        const ErrorModel& errors);

/// The point or the ray that one view has for a joint; none when the view has neither.
[[nodiscard]] std::optional<JointView> point_or_ray_of(const SensorView& view, JointId joint,
                                                       std::uint64_t contributor,
                                                       const ErrorModel& errors);

/// The sensor's bit in FusedBody::contributors; 0 for one that is not listed.
[[nodiscard]] std::uint64_t contributor_of(const SensorId& sensor,
                                           const std::vector<SensorId>& sensors);

/// Sets a fused joint's covariance and, computed from it, the mean variance.
void state_covariance(FusedJoint& fused, const Eigen::Matrix3d& covariance);

/// By how much one view determines a position: the mean of the diagonal of the product `spread` *
/// `information`, by which its measurement is multiplied.  `spread` is the inverse of the summed
/// information of all views, so the results of all views sum to 1.
[[nodiscard]] double pull_of(const Eigen::Matrix3d& information, const Eigen::Matrix3d& spread);

/// True for a point whose depth is hardly known, as from a camera that guesses depth.
[[nodiscard]] bool nearly_a_ray(const Joint& joint);

/// Mean variance per axis [m^2].
[[nodiscard]] double mean_variance(const Eigen::Matrix3d& covariance);

/// Standard deviation along the least certain axis [m].
[[nodiscard]] double largest_sigma(const Eigen::Matrix3d& covariance);

}  // namespace chorus::fusion
