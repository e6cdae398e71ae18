// Follows all sensors: carries out the decisions of PollFsm, reads frames, corrects the sensors'
// clocks.
//
// There is one thread for all sensors, and one or two connections per sensor.  A dead, slow or
// faulty sensor costs the others nothing except network traffic and a tenth of the thread's time.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/http/client.h"
#include "common/resource/frame_resource.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/clock.h"
#include "common/time/clock_estimate.h"
#include "common/time/ntp_status.h"
#include "common/tls/credentials.h"
#include "fusion-server/poll/poll_fsm.h"

namespace chorus::poll {

struct PolledSensor {
  SensorId id;
  std::string url;         ///< The URL of the service's `/`: "http://127.0.0.1:8081/".
  std::string token = {};  ///< Sent with every request; empty: none.
  tls::Trust trust = {};   ///< The authorities accepted for https.

  bool operator==(const PolledSensor&) const = default;
};

struct PolledFrame {
  SensorFrame frame;  ///< With times by our clock, and the latest floor plane.
  std::shared_ptr<const resource::FrameResource> raw;  ///< The frame as the sensor sent it.
  /// The clock estimate with which the capture times were corrected.
  std::optional<ClockEstimate> clock;
};

/// The state of polling one sensor; a copy.
struct PollReport {
  PolledSensor sensor;
  SensorState state = SensorState::Connecting;
  /// What is wrong at present, also with the floor plane of a live sensor.
  std::string last_error;
  bool streaming = false;  ///< True while its frames come by event stream instead of polling.
  std::optional<Timestamp> newest;  ///< Capture time of the newest frame, by our clock.
  double rate_hz = 0.0;             ///< Frames per second that arrived in the last two seconds.
  std::optional<ClockEstimate> clock;
  std::optional<NtpStatus> host;  ///< What its host says of its own clock.
  std::uint64_t frames = 0;
  std::uint64_t missed = 0;  ///< Frames missing from the sensor's numbering: neither delivered nor
                             ///< filled in later.
  std::uint64_t early = 0;   ///< Frames refused because their time is ahead of ours.
  std::uint64_t stale = 0;   ///< Frames refused because their time is far behind ours.
  std::uint64_t failures = 0;
};

struct PollerOptions {
  PollTimings timings;
  std::size_t max_body_bytes = 512u << 10;  ///< Limit for one frame; 64 bodies are about 350 kB.
  std::shared_ptr<const Clock> clock;
  /// Called on the poll thread; must return at once.  If it throws, that poll counts as failed.
  std::function<void(PolledFrame)> deliver;
};

class Poller {
 public:
  explicit Poller(PollerOptions options);
  ~Poller();  ///< Stops all polling and joins the thread.

  /// From now on polls exactly these sensors; those already polled continue undisturbed.  Every url
  /// must be valid for http::parse_url().  Thread-safe.
  void poll(std::vector<PolledSensor> sensors);

  /// Ends all polling; nothing is delivered afterwards.  reports() may still be called.
  void stop();

  [[nodiscard]] std::vector<PollReport> reports() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::poll
