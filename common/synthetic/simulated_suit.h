// A simulated suit: limbs of one person of a scene, each with an inertial sensor that has a mount
// and a heading of its own, noise, skin that moves, drift, and what goes wrong with real ones.
//
// The sensor on a limb says
//   about_y(drift - heading) * world_from_limb * pronation * skin * slip * mount * noise,
// so the calibration that takes it back is SensorCalibration{heading, limb_from_sensor = mount}.
// A pure function of the suit and the time.  Simulated: no proof of anything about real suits.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/units.h"
#include "common/inertial/calibration.h"
#include "common/inertial/inertial_frame.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic {

/// What sensors that work err by.
struct SuitErrors {
  double noise = deg(2.0);  ///< White, per axis and instant [rad]
  /// Skin and muscle against bone, as multiple of what real sensors show on each limb, and forearms
  /// that turn with their hands: coloured (suit_errors.cpp).
  double skin = 0.0;
  bool magnetometer = false;   ///< With one, headings do not drift but can be disturbed.
  double heading_drift = 0.0;  ///< Largest constant drift of a heading [rad/s], of either sign.
  /// Standard deviation of the part of a gyroscope's bias that wanders (over 100 s) [rad/s].
  double bias_walk = 0.0;
};

/// What goes wrong, and when (after the start).
struct SuitFault {
  enum class Kind : std::uint8_t {
    Slip,          ///< The sensor turns on its limb by `size` [rad] about `axis`, and stays.
    Disturbance,   ///< Iron nearby: the heading is off by up to `size` [rad].
    Silence,       ///< Nothing more is heard of the sensor.
    BatteryDeath,  ///< Its charge falls to nothing at `begin`; then silence.
    Swap,          ///< The sensor says what the one on `other` feels, and the reverse.
    Lie,           ///< It states `size` times the standard deviation that it has.
  };
  Kind kind = Kind::Slip;
  inertial::Limb limb = inertial::Limb::Pelvis;
  Duration begin{0};
  Duration end = Duration::max();  ///< Slips and dead batteries do not end.
  double size = 0.0;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< In limb axes; +y is the bone.
  inertial::Limb other = inertial::Limb::Pelvis;
};

struct SimulatedSuit {
  Scene scene;
  std::size_t person = 0;
  std::vector<inertial::Limb> limbs;  ///< Those with a sensor.
  double rate_hz = 100.0;
  std::uint64_t seed = 1;  ///< Of mounts, headings, drifts and noise.
  SuitErrors errors;
  std::vector<SuitFault> faults = {};
  /// Also what the chips measure: angular rate and specific force in sensor axes, with their noise;
  /// costs two more poses an instant.
  bool raw = false;
};

/// 5: as in the paper (shanks, hands, chest); 6 or 13: what suits are sold with.
[[nodiscard]] std::vector<inertial::Limb> limbs_of_suit(int sensors);

/// "tracker-ForearmLeft"
[[nodiscard]] std::string suit_sensor_name(inertial::Limb limb);

/// world_from_limb of a limb of this body: of its bone, +y along it; none where the body does not
/// say.
[[nodiscard]] std::optional<Eigen::Quaterniond> true_limb(const Skeleton<WorldSpace>& body,
                                                          inertial::Limb limb);

/// How each sensor sits at the start; without errors.
[[nodiscard]] inertial::InertialCalibration true_calibration(const SimulatedSuit& suit,
                                                             const SensorId& source);

/// What the suit says at `instant`, having been turned on at `start`.  `number` counts instants and
/// decides the white noise.  Silent sensors are absent.
[[nodiscard]] inertial::InertialFrame suit_at(const SimulatedSuit& suit, Timestamp start,
                                              Timestamp instant, std::uint64_t number);

}  // namespace chorus::synthetic
