// What a picture itself says where a person of known pose stands.  An interface, because programs
// without cameras are built without what reads pictures (outline_sight.h).
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "common/suit/suit_pose.h"

namespace chorus::positioning {

/// Where the person is expected.
struct ExpectedBody {
  const suit::SuitPose& pose;
  double heading = 0.0;                             ///< [rad]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Of SpineBase [m].
};

struct SightedPlace {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();       ///< Of SpineBase [m].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2]
  double heading = 0.0;                                  ///< At which it was looked for [rad].
  double misfit_px = 0.0;                                ///< Mean distance from edges [px].
  bool ambiguous = false;                                ///< Another place fits as well to a tenth.
};

class PictureSight {
 public:
  virtual ~PictureSight() = default;
  /// Madaras et al. 3.5: the best of 25 silhouettes around the last place.  None: all are empty.
  [[nodiscard]] virtual std::optional<SightedPlace> searched(const ExpectedBody& last) const = 0;
  /// The outline nearest to the expected place; none when the person is not there.
  [[nodiscard]] virtual std::optional<SightedPlace> outlined(
      const ExpectedBody& expected) const = 0;
  /// The outline anywhere on the floor, SpineBase at `height` [m]; at any heading, if none is
  /// known.
  [[nodiscard]] virtual std::optional<SightedPlace> anywhere(const suit::SuitPose& pose,
                                                             std::optional<double> heading,
                                                             double height) const = 0;
};

}  // namespace chorus::positioning
