// What fusion makes of a person's views.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/base/strong_id.h"
#include "common/body/hand_points.h"
#include "common/body/skeleton.h"
#include "common/body/stature.h"
#include "common/sensor/shares.h"

namespace chorus {

/// How a joint moves at the instant, according to the method's filter; all errors are alike on
/// every axis.
struct JointMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  double variance = 0.0;                               ///< Of the velocity, per axis [m^2/s^2].
  double shared = 0.0;  ///< Covariance of position and velocity, per axis [m^2/s].
  /// Spectral density of the white-noise acceleration, now and in the long run [m^2/s^3].
  double density = 0.0;
  double usual_density = 0.0;
  /// Variance of the filter's position, per axis [m^2]: what later measurements can still reduce.
  double place_variance = 0.0;
  bool measured = false;  ///< A sensor determined the joint at this instant.
};

struct FusedBody {
  PersonId id;
  Skeleton<WorldSpace> skeleton;
  std::array<double, kJointCount> variance{};  ///< Mean per-axis variance [m^2].
  /// Bit i: Snapshot::sensors[i] contributed.
  std::array<std::uint64_t, kJointCount> contributors{};
  std::array<Shares, kJointCount> shares{};  ///< Of Snapshot::sensors[i], at that index.
  /// Time since a sensor last contributed to the joint [s]: 0 where one does now, more where the
  /// joint is only expected.
  std::array<double, kJointCount> age{};
  std::optional<std::size_t> slot;  ///< The person's slot in every output; none: no slot.
  std::optional<double> sides_confidence = {};  ///< Copied from Person.
  /// For how long no sensor has seen the person [s]; meanwhile they are where they are expected.
  /// None while they are seen.
  std::optional<double> carried_for = {};
  /// For how long after the instant what sensors saw was taken into account [s]; none: the body is
  /// what was known at the instant.
  std::optional<double> smoothed_over = {};
  /// Of the skeleton's orientations, about the axes of the world [rad^2], where the method knows
  /// it.
  std::array<Covariance, kJointCount> orientation_covariance = {};
  std::string_view method = {};  ///< The fusion method's name (fusion/methods.h).
  /// What the method has learned of the person's build; none: it learns nothing.
  std::optional<BoneLengthOf> bones = {};
  std::optional<LearnedLength> stature = {};
  /// For predictions (fusion/prediction.h); none: the method has no velocities.
  std::optional<std::array<JointMotion, kJointCount>> motion = {};
  /// The inertial sources that had a say; bit i of `worn_contributors`: worn_sources[i] in a joint.
  std::vector<SensorId> worn_sources = {};
  std::array<std::uint64_t, kJointCount> worn_contributors = {};
  /// By how much they, not the views, determine the position [0, 1].
  std::array<double, kJointCount> worn_share = {};
  /// The joints of the hands, where a sensor tells them, in the world.
  HandsPtr hands = {};
  /// The joints before inertial sensors had their say; none: they had none.
  std::optional<Skeleton<WorldSpace>> sighted = {};
};

}  // namespace chorus
