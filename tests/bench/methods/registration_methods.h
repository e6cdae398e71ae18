// The registration methods that are compared, and how a result is scored against the truth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fusion-server/registration/registration.h"
#include "tests/judge/judge.h"

namespace chorus::bench {

struct RegistrationMethod {
  std::string name;
  std::function<Registration(const std::vector<registration::WalkTrack>&, Timestamp now,
                             const SensorId& master)>
      solve;
};

/// Our method with the shipped defaults.
[[nodiscard]] RegistrationMethod our_registration();
/// "trajectory-icp": time as a coordinate; "closed-form": time-interpolated pairs, least squares.
[[nodiscard]] std::vector<RegistrationMethod> timed_baselines();
/// "icp", which is PCL ICP on neck clouds without time (Otto), followed by the timed_baselines().
[[nodiscard]] std::vector<RegistrationMethod> all_baselines();
/// Variants of our method, each with one part left out.
[[nodiscard]] std::vector<RegistrationMethod> registration_ablations();

/// One registration compared with the truth; errors are means over the sensors other than the
/// master, and NaN if any of them was refused.
struct Score {
  double position = 0.0;        ///< NaN where a sensor was refused [m]
  double position_worst = 0.0;  ///< As above [m]
  double horizontal = 0.0;      ///< As above [m]
  double vertical = 0.0;        ///< As above [m]
  double yaw = 0.0;             ///< As above [rad]
  double pitch_roll = 0.0;      ///< As above [rad]
  double centre = 0.0;          ///< As above; at the workspace centre, 1 m above the floor [m]
  std::size_t asked = 0;        ///< Number of sensors.
  std::size_t refused = 0;      ///< Number of sensors that were left out, with a reason.
  std::size_t lost = 0;         ///< Number of sensors that were placed more than 100 mm off.
  /// Number of sensors whose 95 % ellipse on the floor contains the truth.
  std::size_t covered = 0;
  std::size_t inside = 0;  ///< Number of sensors within their stated 95 % radius on the floor.
  std::vector<double> stated = {};  ///< These radii [m].
  std::vector<double> off = {};     ///< The true errors on the floor, in the same order [m].
};

/// Scores these sensors; a master among them is skipped, because it defines the world.
[[nodiscard]] Score score_of(const Workshop& workshop, const Registration& solved,
                             const std::vector<SensorId>& sensors);

}  // namespace chorus::bench
