// Where the device `inertial` gets what worn sensors say.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "common/base/result.h"
#include "common/inertial/inertial_frame.h"
#include "common/inertial/stream_reader.h"
#include "services/sensor/device/host_time.h"

namespace chorus::inertial_device {

using TakeInstant = std::function<void(inertial::InertialFrame)>;

class InertialFeed {
 public:
  virtual ~InertialFeed() = default;

  /// Human-readable: "simulated suit with 13 sensors".
  [[nodiscard]] virtual std::string label() const = 0;
  [[nodiscard]] virtual double rate_hz() const = 0;
  /// Gives instants in the order of their times, stamped by the host's clock, numbered from 1,
  /// until stopped or at the end of a recording.
  [[nodiscard]] virtual Result<void> run(std::stop_token stop, const TakeInstant& take) = 0;
};

/// Waits until the clock shows an instant; false when told to stop before.  Looks at the clock
/// again every now and then, because it may be set.
[[nodiscard]] bool wait_until(const Clock& clock, const std::stop_token& stop, Timestamp until);

/// A recording's /inertial/{id}/orientations again, with times of today.
struct ReplayedSuit {
  std::string recording;
  SensorId source;  ///< Which of several; a recording of one is played under any name.
  bool loop = true;
  double speed = 1.0;
};
[[nodiscard]] Result<std::unique_ptr<InertialFeed>> open_replayed_suit(
    const ReplayedSuit& settings, sensor_service::HostTime time);

/// The server that trackers with SlimeVR's firmware, and phones with owoTrack, connect to (UDP).
struct SlimevrServer {
  std::string address = "0.0.0.0";
  std::uint16_t port = 6969;
};
[[nodiscard]] std::unique_ptr<InertialFeed> make_slimevr_feed(const SlimevrServer& settings,
                                                              sensor_service::HostTime time);

/// A maker's stream: over UDP, or over a TCP connection that this side makes again and again.
struct LiveStream {
  std::string name;  ///< For people: "Sony mocopi".
  std::unique_ptr<inertial::StreamReader> reader;
  bool connects = false;
  std::string address = "0.0.0.0";  ///< To listen on, or the host to connect to.
  std::uint16_t port = 0;
};
[[nodiscard]] std::unique_ptr<InertialFeed> make_stream_feed(LiveStream settings,
                                                             sensor_service::HostTime time);

}  // namespace chorus::inertial_device
