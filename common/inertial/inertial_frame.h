// What the inertial sensors of one source (a suit, a set of trackers, one phone) say at one
// instant.
//
// Inertial space: right-handed, metres, +y up like all our spaces; where +x and +z point to is each
// sensor's own affair (on real suits headings spread by 44 and 62 degrees), only gravity is common.
// Whoever reads a source whose world has +z up turns it with y_up_from_z_up().  Sensor axes stay as
// the maker has them.  Orientations are Hamilton quaternions inertial_from_sensor: the paper's
// q^I(t), which takes F^LI to F^GI (Baak et al., 3.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "common/inertial/limb.h"
#include "common/time/timestamp.h"

namespace chorus::inertial {

/// Largest number of sensors of one source; a frame with more is refused.
inline constexpr std::size_t kMaxInertialSensors = 64;
/// Longest name of a sensor [bytes].
inline constexpr std::size_t kMaxSensorName = 64;

/// What is known of the magnetic field at a sensor, and so of its heading.
enum class MagneticState : std::uint8_t {
  Unknown,      ///< The source does not say.
  Undisturbed,  ///< The heading comes from a field that looks like the earth's.
  Disturbed,    ///< The field is not the earth's: the heading may be wrong.
  None,         ///< No magnetometer, or it is not used: the heading drifts.
};

/// "unknown", "undisturbed", "disturbed", "none".
[[nodiscard]] std::string_view name_of(MagneticState state) noexcept;
[[nodiscard]] std::optional<MagneticState> magnetic_state_named(std::string_view name);

/// One sensor at one instant.  What a source does not measure is absent.
struct InertialReading {
  std::string sensor;             ///< The maker's name or serial number; unique in the source.
  Timestamp captured;             ///< Of this sensor, by the clock of the source.
  std::optional<Limb> limb = {};  ///< If the source knows what wears it.
  std::optional<Eigen::Quaterniond> inertial_from_sensor = {};
  /// Of the rotation vector in inertial space, world_from_true = exp(error) * stated [rad^2].
  std::optional<Eigen::Matrix3d> covariance = {};
  std::optional<Eigen::Vector3d> acceleration = {};  ///< Specific force in sensor axes [m/s^2].
  /// Acceleration without gravity in inertial space [m/s^2], from sources that give only this.
  std::optional<Eigen::Vector3d> free_acceleration = {};
  std::optional<Eigen::Vector3d> rate = {};   ///< Angular rate in sensor axes [rad/s].
  std::optional<Eigen::Vector3d> field = {};  ///< Magnetic field in sensor axes, in any one unit.
  MagneticState magnetic = MagneticState::Unknown;
  std::optional<double> battery = {};  ///< Charge, 0 to 1.
};

struct InertialFrame {
  SensorId source;
  std::uint64_t sequence = 0;  ///< Counts the source's frames; a gap means lost frames.
  Timestamp captured;          ///< By the clock of the source's host.
  Timestamp received;          ///< When this process got it, by its own clock.
  std::vector<InertialReading> readings;
};

/// Turns a world with +z up (x ahead, y left: Xsens, OpenSense's sensors, VQF) into ours:
/// (x, y, z) -> (y, z, x), as motion/mvnx does for segments.
[[nodiscard]] Eigen::Quaterniond y_up_from_z_up();

/// The frame as others may rely on: refuses, by name, two sensors of one name, a name that is
/// empty, too long or not printable, too many sensors, numbers that are not finite, and quaternions
/// whose norm is not within 0.05 of 1 (nearer ones are normalised).
[[nodiscard]] Result<InertialFrame> checked(InertialFrame frame);

}  // namespace chorus::inertial
