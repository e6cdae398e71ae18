// Where a person stands whose pose is known from a suit: the pose is put onto the rays of landmarks
// that cameras see.  Pure.
//
// Minimises over the place p and the heading h, for all cameras together,
//   sum rho(|B_i' (R_h X_i + p - c_i)| / s_i) + (h - h_0)^2 / sigma_h^2
// by Gauss-Newton.  X_i: joints of the suit's pose.  B_i: two axes across ray i.  c_i: the camera's
// place.  s_i: the standard deviation across the ray, from pose, landmark and ray.  rho: Huber's
// loss.  body_placing.h solves the same for one camera and a shape that the camera itself guesses;
// here the shape is upright and of known size, so only its heading is free.
#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "common/body/skeleton.h"
#include "common/suit/suit_pose.h"

namespace chorus::positioning {

/// What one camera sees of one person.
struct SeenRays {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  Skeleton<SensorSpace> rays;  ///< Joints as rays; joints that are points are ignored.
};

struct HeadingPrior {
  double heading = 0.0;  ///< [rad]
  double sigma = 0.3;    ///< [rad]
};

struct LandmarkFit {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Of SpineBase in the world [m].
  double heading = 0.0;                             ///< [rad]
  /// Of (place, heading), by the geometry and the residuals alone: what all joints have in common
  /// (size, the camera's place) is not in it.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  double misfit = 0.0;   ///< Root mean square of the residuals, robust [standard deviations].
  std::size_t used = 0;  ///< Number of rays.
};

/// Fewest rays of joints that the pose has too.
inline constexpr std::size_t kFewestRays = 6;
/// A fit with a larger misfit is of another person, another instant or another camera.
inline constexpr double kLargestMisfit = 2.5;

/// Which of a network's labels are exchanged between left and right: a network confuses the sides
/// of a whole person, of the legs alone or of the arms alone.
enum class Exchanged { Nothing, Legs, Arms, Everything };
inline constexpr std::array kExchanges{Exchanged::Nothing, Exchanged::Legs, Exchanged::Arms,
                                       Exchanged::Everything};
/// By how much another labelling than the network's must make the squared misfit smaller.  Of real
/// pictures that are labelled rightly it is 0.06 to 0.4, of exchanged ones 1.7 to 3.2.
inline constexpr double kExchangeCost = 0.5;

[[nodiscard]] Skeleton<SensorSpace> relabelled(Skeleton<SensorSpace> rays, Exchanged what);

/// None when fewer than kFewestRays rays can be used, when they are parallel, or when no person
/// in front of the cameras fits.
[[nodiscard]] std::optional<LandmarkFit> fit_landmarks(std::span<const SeenRays> cameras,
                                                       const suit::SuitPose& pose,
                                                       const HeadingPrior& prior);

/// The best fit over all headings, for when none is known.
[[nodiscard]] std::optional<LandmarkFit> fit_any_heading(std::span<const SeenRays> cameras,
                                                         const suit::SuitPose& pose);

}  // namespace chorus::positioning
