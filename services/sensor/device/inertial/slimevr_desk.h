// The server that SlimeVR trackers look for, without the socket: answers their packets, and gathers
// what they say into instants.
//
// Trackers have no common clock and stamp nothing: a reading's time is that of its arrival.  A
// tracker is known by its address; its name is its MAC, with "/n" for the n-th sensor on its cable.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/inertial/inertial_frame.h"
#include "common/inertial/slimevr.h"

namespace chorus::inertial_device {

/// A datagram to send, and to whom.
struct Outgoing {
  std::string to;
  std::string datagram;
};

/// Not thread-safe; time is an argument.
class SlimevrDesk {
 public:
  static constexpr std::size_t kMostTrackers = 32;
  static constexpr Duration kForgotten = std::chrono::seconds(10);
  static constexpr Duration kHeartbeat = std::chrono::milliseconds(500);

  /// Takes a datagram; returns the answers.  What cannot be read, comes from a stranger who has not
  /// shaken hands, or repeats a packet is counted and otherwise ignored.
  [[nodiscard]] std::vector<Outgoing> hear(const std::string& from, std::string_view datagram,
                                           Timestamp now);

  /// What the trackers have said since the last call; none if nothing.  A sensor that has turned
  /// several times makes several instants: ask until there is none.
  [[nodiscard]] std::optional<inertial::InertialFrame> instant(Timestamp now);

  /// What keeps trackers from looking for another server; forgets those that are silent.
  [[nodiscard]] std::vector<Outgoing> heartbeats(Timestamp now);

  [[nodiscard]] std::size_t trackers() const noexcept { return trackers_.size(); }
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }
  /// Why the last refused datagram was refused; empty if none was.
  [[nodiscard]] const std::string& last_refusal() const noexcept { return last_refusal_; }

 private:
  struct Tracker {
    std::string name;
    Timestamp heard;
    std::uint64_t number = 0;  ///< Of the newest packet.
    std::optional<double> battery;
    inertial::MagneticState magnetic = inertial::MagneticState::None;
    std::map<std::uint8_t, inertial::InertialReading>
        fresh;                                          ///< By sensor, since the last instant.
    std::map<std::uint8_t, Eigen::Quaterniond> latest;  ///< inertial_from_sensor, by sensor.
  };

  void refuse(std::string why);
  std::optional<std::string> take(Tracker& tracker, const inertial::slimevr::Content& content,
                                  Timestamp now);
  inertial::InertialReading& reading_of(Tracker& tracker, std::uint8_t sensor, Timestamp now);
  void greet(const std::string& from, const inertial::slimevr::Handshake& handshake, Timestamp now);

  [[nodiscard]] std::optional<inertial::InertialFrame> gather(Timestamp now);

  std::map<std::string, Tracker> trackers_;      ///< By address.
  std::deque<inertial::InertialFrame> waiting_;  ///< Instants that are complete.
  Timestamp turned_{};                           ///< When a sensor last turned.
  std::uint64_t instants_ = 0;
  std::uint64_t refused_ = 0;
  std::string last_refusal_;
  std::optional<Timestamp> beaten_;
};

}  // namespace chorus::inertial_device
