// From placed hands to what a sensor says of them: frames, and the resource `/hands`.  Pure.
#pragma once

#include <string>

#include "common/hand/bvh.h"
#include "common/sensor/sensor_frame.h"
#include "services/sensor/device/glove/glove_eye.h"

namespace chorus::glove {

/// The 21 joints in sensor space (x left, y up, z ahead) [m], in the order of hand_21.
struct SeenJoints {
  hand::Side side = hand::Side::Right;
  std::array<Eigen::Vector3d, hand::kHandJoints> joints{};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Of the wrist [m^2].
};

[[nodiscard]] SeenJoints joints_in_sensor(const hand::Skeleton& skeleton, const PlacedHand& placed);

/// A body of which the wrist, the middle of the hand, the middle finger's tip and the thumb's are
/// known, with the covariance of the wrist and, beyond it, that of the fingers' angles; and all 21
/// joints as a hand of the body.
[[nodiscard]] BodyFrame body_of(const SeenJoints& hand, Timestamp captured);

/// {"sensor", "captured", "space", "hands": [{"side", "layout", "joints", "covariance"}]}; `hand`:
/// null when none is seen.
[[nodiscard]] std::string hands_json(const SensorId& sensor, Timestamp captured,
                                     const SeenJoints* hand);

}  // namespace chorus::glove
