// The protocol between SlimeVR trackers (also owoTrack phones and bridges of other makers) and the
// server they connect to: UDP, one packet a datagram, or several in a bundle.
//
// Big-endian: u32 type, u64 packet number, then the content; in a bundle (type 100) each packet has
// a u16 length before it and no number.  Rotations are x y z w and turn the tracker's axes to a
// world with +z up; accelerations are without gravity, in the tracker's axes [m/s^2].  Layouts as
// the project's own packages @slimevr/firmware-protocol 0.6.6 write them (MIT or Apache-2.0).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus::inertial::slimevr {

inline constexpr std::uint16_t kDefaultPort = 6969;
/// A larger datagram is refused.
inline constexpr std::size_t kMaxDatagram = 1472;

struct Heartbeat {};
/// A tracker that looks for a server; the answer is handshake_answer().
struct Handshake {
  std::uint32_t board = 0, imu = 0, mcu = 0;
  std::int32_t firmware_build = 0;
  std::string firmware;  ///< Printable characters alone.
  std::array<std::uint8_t, 6> mac{};
};
struct Rotation {
  std::uint8_t sensor = 0;
  Eigen::Quaterniond world_from_tracker =
      Eigen::Quaterniond::Identity();  ///< +z up, of unit length
};
struct Acceleration {
  std::uint8_t sensor = 0;
  Eigen::Vector3d in_tracker = Eigen::Vector3d::Zero();  ///< Without gravity [m/s^2]
};
struct Battery {
  double volts = 0.0;   ///< 0: not said.
  double charge = 0.0;  ///< 0 to 1
};
struct SensorState {
  std::uint8_t sensor = 0;
  std::uint8_t status = 0;  ///< 1: works, 2: has failed.
  std::uint8_t type = 0;
};
struct MagnetometerAccuracy {
  std::uint8_t sensor = 0;
  double radians = 0.0;
};
struct Pong {
  std::int32_t id = 0;
};
/// A type that we do not use.
struct Other {
  std::uint32_t type = 0;
};

using Content = std::variant<Heartbeat, Handshake, Rotation, Acceleration, Battery, SensorState,
                             MagnetometerAccuracy, Pong, Other>;
struct Packet {
  std::uint64_t number = 0;  ///< Counts a tracker's packets; 0 in a bundle and in a handshake.
  Content content;
};

/// All packets of one datagram.  Refuses what is cut off, quaternions that are not of unit length,
/// numbers that are not finite, and bundles in bundles.
[[nodiscard]] Result<std::vector<Packet>> parse(std::string_view datagram);

/// What a tracker sends: for simulated trackers and tests.
[[nodiscard]] std::string encode(const Packet& packet);
/// Several packets as one datagram.
[[nodiscard]] std::string encode_bundle(const std::vector<Packet>& packets);

/// What the server answers to a handshake: 64 bytes that begin with 3 and "Hey OVR =D 5".
[[nodiscard]] std::string handshake_answer();
/// What the server sends at least every second, or trackers look for another one.
[[nodiscard]] std::string heartbeat();
[[nodiscard]] std::string ping(std::int32_t id);
/// Confirms a SensorState, which trackers repeat until then.
[[nodiscard]] std::string sensor_answer(const SensorState& state);

}  // namespace chorus::inertial::slimevr
