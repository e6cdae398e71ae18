// Which method fuses the views of a person, and its parameters.
#pragma once

#include <map>

#include "common/base/duration.h"
#include "common/base/strong_id.h"
#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/error_predictor.h"
#include "fusion-server/fusion/inertial_model.h"
#include "fusion-server/fusion/noise_model.h"
#include "fusion-server/fusion/pose_error.h"

namespace chorus::fusion {

/// Rows of the table in methods.h.
enum class Method {
  /// Weighted mean by Eqs. (1)-(3), orientation by LERP; if all weights are zero: decision 0007.
  Otto,
  Mean,      ///< Unweighted mean of the seen joints.
  BestView,  ///< Only the view of highest weight; of equal ones, that with more tracked joints.
  InverseVariance,  ///< Anisotropic inverse variance along and across the line of sight, robust.
  BestSkeleton,     ///< One view alone.  While it lasts, a better one takes over only after
                    ///< `hysteresis`.  Has memory.
  JointCounting,    ///< Only the view with the most tracked joints.
  Substitution,     ///< The best skeleton, untracked joints from other views.  Has memory.
  OttoKalman,       ///< A Kalman filter per joint with Otto's weights in R.  Has memory.
  PointsAndRays,    ///< Robust least squares over points and rays of cameras.  Has memory.
  BodyFilter,       ///< One body over time, with its bones and the errors of whole views.  Has
                    ///< memory.
};

struct FusionConfig {
  Method method = Method::BodyFilter;
  /// Otto weight given to every view that saw a joint when all their weights are zero (decision
  /// 0007); if this is 0, such a joint stays NotTracked.
  double zero_weight_floor = 0.02;
  NoiseModel noise;  ///< For sensors without an entry of their own.
  std::map<SensorId, NoiseModel> sensor_noise;
  /// Learned errors of the sensors without an entry of their own; none: their noise and pose error.
  SharedPredictor errors = {};
  std::map<SensorId, SharedPredictor> sensor_errors = {};
  /// InverseVariance and BodyFilter add this to the covariance that they state, for views that
  /// state none themselves.
  PoseError pose_error;
  double common_sigma = 0.004;  ///< Error common to all sensors [m]; added to stated variances.
  /// Threshold of the robust loss [standard deviations]: of InverseVariance, of PointsAndRays, and
  /// of BodyFilter for joints that have a ray or a stated covariance.
  double huber = 1.5;
  /// BestSkeleton, Substitution: how long another view must be better before it takes over.
  Duration hysteresis = std::chrono::milliseconds(300);
  /// OttoKalman: standard deviation of a view of weight 1 [m].
  double kalman_sigma = 0.020;
  /// OttoKalman: how long a joint that no sensor sees is predicted.  PointsAndRays: how long a
  /// joint's last position limits its depth when only one ray shows it.
  Duration kalman_coast = std::chrono::milliseconds(300);

  /// PointsAndRays, BodyFilter: rays alone do not determine a joint if they leave its position less
  /// certain than this [m].
  double max_sigma = 0.15;
  BodyModel body;          ///< Parameters of BodyFilter.
  InertialModel inertial;  ///< Of worn inertial sensors, behind every method.

  bool operator==(const FusionConfig&) const = default;
};

}  // namespace chorus::fusion
