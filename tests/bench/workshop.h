// A simulated workshop with its truth, and how far estimates are from it.  Shared by the accuracy
// benchmarks and the accuracy tests; algorithms never include it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/synthetic/sensor_model.h"
#include "fusion-server/flow.h"
#include "fusion-server/registration/registration.h"

namespace chorus::bench {

struct Workshop {
  synthetic::Scene scene;
  std::vector<synthetic::SimulatedSensor> sensors;
  Timestamp begin;
};

/// One walking person amid these sensors; s1 is the first.
[[nodiscard]] Workshop make_workshop(std::uint64_t seed,
                                     std::vector<Eigen::Isometry3d> world_from_sensor);

/// Two sensors of a ring, `angle` apart.
[[nodiscard]] std::vector<Eigen::Isometry3d> pair_places(double angle);

/// What every sensor sees for so long from the beginning on.
[[nodiscard]] std::vector<registration::WalkTrack> walk(const Workshop& workshop,
                                                        Duration duration);

/// The registered world as it truly lies in the scene when this sensor is the master: origin on the
/// floor under it, +z where it looks.
[[nodiscard]] Eigen::Isometry3d world_from_scene(const Workshop& workshop, const SensorId& master);

/// Where a sensor truly is in that world.
[[nodiscard]] Eigen::Isometry3d true_place(const Workshop& workshop, const SensorId& sensor,
                                           const SensorId& master);

/// The truth as a registration.
[[nodiscard]] Registration true_registration(const Workshop& workshop, const SensorId& master);

struct PlaceError {
  double position = 0.0;    ///< [m]
  double yaw = 0.0;         ///< About the true vertical [rad]
  double pitch_roll = 0.0;  ///< Tilt of the vertical [rad]
};

/// Estimated against true.  World-from-sensor places, or sensor-from-sensor ones with `up` = the
/// target sensor's own up.
[[nodiscard]] PlaceError place_error(const Eigen::Isometry3d& estimated,
                                     const Eigen::Isometry3d& exact,
                                     const Eigen::Vector3d& up = Eigen::Vector3d::UnitY());

/// Mean joint errors against the truth, and how much was seen.
struct JointError {
  double sum = 0.0;        ///< [m]
  std::size_t joints = 0;  ///< Seen.
  std::size_t asked = 0;   ///< All joints of all instants.

  [[nodiscard]] double mean() const;  ///< NaN when nothing was seen.
  [[nodiscard]] double coverage() const;
};

void compare(const Skeleton<WorldSpace>& body, const Skeleton<WorldSpace>& exact,
             JointError& error);

/// Of fused bodies; an instant without a body counts as all joints unseen, one with several as its
/// first.
[[nodiscard]] JointError fused_error(const Workshop& workshop,
                                     const std::vector<Snapshot>& snapshots,
                                     const SensorId& master);

/// Of one sensor's raw frames put into the world by these extrinsics.
[[nodiscard]] JointError raw_error(const Workshop& workshop, const registration::WalkTrack& track,
                                   const Registration& registration);

}  // namespace chorus::bench
