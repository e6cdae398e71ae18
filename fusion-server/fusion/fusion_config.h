// Which method fuses the views of a person, and its parameters.
#pragma once

#include <map>

#include "fusion-server/flow.h"
#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/noise_model.h"
#include "fusion-server/fusion/pose_error.h"

namespace chorus::fusion {

/// Rows of the table in methods.h.
enum class Method {
  /// Weighted mean by Eqs. (1)-(3), orientation by LERP; if all are zero: decision 0007.
  Otto,
  Mean,             ///< Plain mean of the seen joints.
  BestView,         ///< The heaviest view alone; in a tie, the one with more tracked joints.
  InverseVariance,  ///< Anisotropic inverse variance along and across the line of sight, robust.
  BestSkeleton,     ///< One view alone; changes hands only after a while.  Remembers.
  OttoKalman,       ///< A Kalman filter per joint with Otto's weights in R.  Remembers.
  PointsAndRays,    ///< Robust least squares over points and rays of cameras.  Remembers.
  BodyFilter,       ///< One body over time: bones, what views err by as a whole.  Remembers.
};

struct FusionConfig {
  Method method = Method::InverseVariance;
  /// Otto weight of every view that saw a joint when all of their weights are zero (decision 0007);
  /// 0 leaves such a joint NotTracked.
  double zero_weight_floor = 0.02;
  NoiseModel noise;  ///< For sensors without an entry of their own.
  std::map<SensorId, NoiseModel> sensor_noise;
  PoseError pose_error;         ///< InverseVariance: part of the stated covariance.
  double common_sigma = 0.004;  ///< Error all sensors share [m]; added to the stated variance.
  double huber = 1.5;  ///< In standard deviations; robust loss of InverseVariance, PointsAndRays.
  /// BestSkeleton: how long another view must be better before it takes over.
  Duration hysteresis = std::chrono::milliseconds(300);
  /// OttoKalman: standard deviation of a view of weight 1 [m].
  double kalman_sigma = 0.020;
  /// OttoKalman: how long a joint that nobody sees is predicted.  PointsAndRays: how long its last
  /// place bounds the depth of a joint that a single ray shows.
  Duration kalman_coast = std::chrono::milliseconds(300);

  /// PointsAndRays: a joint that rays determine less well than this is missing [m].
  double max_sigma = 0.15;
  BodyModel body;  ///< BodyFilter.

  bool operator==(const FusionConfig&) const = default;
};

}  // namespace chorus::fusion
