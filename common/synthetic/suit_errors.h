// What a sensor of a simulated suit errs by, as pure functions of the suit and the time.
#pragma once

#include "common/synthetic/draw.h"
#include "common/synthetic/simulated_suit.h"

namespace chorus::synthetic {

/// Of skin and muscle against bone on a real person: robust standard deviations of what calibrated
/// sensors leave against Vicon (`chorus-bench inertial --only residual-real`, 13 sensors, mean of
/// left and right, rounded), and how long errors stay alike.  Nobody has measured hands: as
/// forearms without their pronation, which a hand has not against itself.
struct SkinRow {
  double side = 0.0;   ///< About the limb's +x [rad]
  double twist = 0.0;  ///< About the bone, +y [rad]
  double ahead = 0.0;  ///< About +z [rad]
  double tau = 0.4;    ///< [s]
};
[[nodiscard]] SkinRow skin_of(inertial::Limb limb);

/// By how much a forearm turns about its bone between elbow and sensor, with the hand [rad]; 0 on
/// other limbs.  Seldom far: 32 % of the time by more than 6 degrees, 10 % by more than 30 (the
/// same measurement; evaluation/pronation.h has what it is).  Grows with SuitErrors::skin.
[[nodiscard]] double pronation(const SimulatedSuit& suit, inertial::Limb limb, double since);

/// The rotation of the skin in limb axes, `since` seconds after the start.
[[nodiscard]] Eigen::Quaterniond skin_error(const SimulatedSuit& suit, inertial::Limb limb,
                                            double since);

/// What the sensor's heading is off by, from drift and from disturbed fields [rad].
[[nodiscard]] double heading_error(const SimulatedSuit& suit, inertial::Limb limb, double since);

/// The same from disturbed fields alone; 0 while there is none.
[[nodiscard]] double disturbance(const SimulatedSuit& suit, inertial::Limb limb, double since);

/// Turned on its limb so far, in limb axes.
[[nodiscard]] Eigen::Quaterniond slip_error(const SimulatedSuit& suit, inertial::Limb limb,
                                            double since);

/// Charge, 0 to 1; nothing once the sensor is silent.
[[nodiscard]] std::optional<double> charge_left(const SimulatedSuit& suit, inertial::Limb limb,
                                                double since);

/// The limb that the sensor named after `limb` feels now: another one while two are swapped.
[[nodiscard]] inertial::Limb felt_limb(const SimulatedSuit& suit, inertial::Limb limb,
                                       double since);

/// Standard deviation that the sensor states of itself, as a multiple of the true one.
[[nodiscard]] double stated_share(const SimulatedSuit& suit, inertial::Limb limb, double since);

}  // namespace chorus::synthetic
