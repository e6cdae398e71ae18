// Where the sensors stand beside where another tracker saw rigid bodies on them (Otto, Section 7:
// the pivots of the bodies are in the focal points of the depth cameras).
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/flow/registration.h"
#include "services/ctl/align/reference_file.h"

namespace chorus::ctl {

/// The body that is called as the sensor, at rest: medians of its samples, in the reference's
/// world.
struct SensorMark {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> turn = {};
};
[[nodiscard]] std::map<SensorId, SensorMark> sensor_marks(const Reference& reference,
                                                          const Registration& registration);

/// Best yaw and translation by the positions of the sensors.  NotFound: fewer than two marks, or
/// all within 0.5 m.
[[nodiscard]] Result<Eigen::Isometry3d> ours_from_marks(const std::map<SensorId, SensorMark>& marks,
                                                        const Registration& registration);

struct SensorDeviation {
  SensorId sensor;
  double horizontal = 0.0;  ///< Distance in the floor plane [m].
  double vertical = 0.0;    ///< Ours minus the reference's [m].
  /// Ours minus the reference's [rad]; only with `sensor_axes`.
  std::optional<double> yaw = {};
  std::optional<double> pitch = {};
};

/// `sensor_axes`: the bodies have the axes of the sensors (+z into the scene, +y up), not just
/// their pivots in them.
[[nodiscard]] std::vector<SensorDeviation> deviations(const std::map<SensorId, SensorMark>& marks,
                                                      const Registration& registration,
                                                      const Eigen::Isometry3d& ours_from_reference,
                                                      bool sensor_axes);

/// ours_from_reference that puts the master where its body is, as in Otto's Figure 12; none if the
/// reference does not have it with a turn.
[[nodiscard]] std::optional<Eigen::Isometry3d> by_master(
    const std::map<SensorId, SensorMark>& marks, const Registration& registration);

}  // namespace chorus::ctl
