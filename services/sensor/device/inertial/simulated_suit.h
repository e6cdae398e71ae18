// A simulated suit: the limbs of one person of a scene, each with a sensor that has a mount and a
// heading of its own, noise, drift, and perhaps slips.
//
// The sensor on a limb says about_y(-heading) * world_from_limb * mount * noise: the calibration
// that takes it back is SensorCalibration{heading, limb_from_sensor = mount}.  Simulated numbers
// are no proof of anything about real suits, whose errors are larger and coloured.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/inertial/calibration.h"
#include "common/inertial/inertial_frame.h"
#include "common/synthetic/scene.h"

namespace chorus::inertial_device {

struct SimulatedSuit {
  synthetic::Scene scene;
  std::size_t person = 0;
  std::vector<inertial::Limb> limbs;  ///< Those with a sensor.
  double rate_hz = 100.0;
  double noise = 0.035;                      ///< Per axis and instant, white [rad]: 2 degrees.
  double heading_drift = 0.0;                ///< Largest drift of a heading [rad/s].
  std::uint64_t seed = 1;                    ///< Of mounts, headings, drifts and noise.
  std::optional<inertial::Limb> slips = {};  ///< Whose sensor slips,
  Duration slips_after{0};                   ///< this long after the start,
  double slips_by = 1.05;  ///< about the limb's axis by so much [rad]: 60 degrees.
};

/// Six or thirteen limbs: what suits are sold with.
[[nodiscard]] std::vector<inertial::Limb> limbs_of_suit(int sensors);

/// How each sensor sits at the start; without errors.
[[nodiscard]] inertial::InertialCalibration true_calibration(const SimulatedSuit& suit,
                                                             const SensorId& source);

/// What the suit says at `instant`; pure.  `number` counts instants, and decides the noise.
[[nodiscard]] inertial::InertialFrame suit_at(const SimulatedSuit& suit, Timestamp start,
                                              Timestamp instant, std::uint64_t number);

}  // namespace chorus::inertial_device
