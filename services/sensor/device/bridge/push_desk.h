// Receives pushed frames: one program at a time holds the sensor, and its frames go to the device's
// thread.  Also tells people the state.  Thread-safe, no IO.
//
// A program holds the sensor from its hello until it leaves; one that has pushed no frame for
// `yields_after` makes room for another.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/handover.h"
#include "common/base/rate_report.h"
#include "common/sensor/frame_source.h"
#include "common/time/clock.h"
#include "common/time/clock_estimate.h"
#include "services/sensor/device/bridge/bridge_settings.h"
#include "services/sensor/device/bridge/push_message.h"

namespace chorus::bridge {

using SteadyTime = std::chrono::steady_clock::time_point;
using SteadyNow = std::function<SteadyTime()>;

/// What the desk knows about a program.
struct Pusher {
  std::string name;
  std::string layout;
  std::string via;      ///< "WebSocket", "HTTP POST" or "local socket".
  std::string address;  ///< Its address; empty for a local socket.
};

struct PushStatus {
  std::string state;   ///< "waiting" (for a program), "silent" or "live".
  std::string reason;  ///< Why the state is not live, for people.
  std::optional<Pusher> pusher;
  Timestamp since{};           ///< When the pusher took the sensor.
  std::uint64_t frames = 0;    ///< Frames accepted from it.
  std::uint64_t refused = 0;   ///< Messages from it that were refused.
  std::uint64_t left_out = 0;  ///< Its frames beyond the maximum rate.
  std::string last_error;      ///< The error for its last refused message.
  std::optional<ClockEstimate> clock;
};

struct DeskOptions {
  SensorId sensor;
  BridgeSettings settings;
  std::shared_ptr<const Clock> clock;  ///< The clock of this host.
  SteadyNow steady_now = [] { return std::chrono::steady_clock::now(); };
};

class PushDesk {
 public:
  using Seat = std::uint64_t;  ///< A new number for each program that takes the sensor; never 0.

  explicit PushDesk(DeskOptions options);

  [[nodiscard]] const DeskOptions& options() const { return options_; }
  [[nodiscard]] Timestamp now() const { return options_.clock->now(); }
  [[nodiscard]] SteadyTime steady_now() const { return options_.steady_now(); }

  // A connection counts towards max_pushers as soon as it is open, before its hello.

  /// Unavailable when there are too many connections, or just after a flood.
  [[nodiscard]] Result<void> connect();
  void disconnect();
  /// Called when a program was disconnected for flooding: no new one is let in for a second.
  void shut_for_a_moment();

  /// Conflict while another program is pushing; the error names it.
  [[nodiscard]] Result<Seat> sit_down(const Pusher& pusher);
  [[nodiscard]] bool sits(Seat seat) const;
  void leave(Seat seat, std::string_view why);

  /// Takes a frame whose times are by this host's clock.  Refuses it when its capture time does not
  /// advance; but a step back of more than a second, or one that two frames in a row agree on,
  /// means that a clock was set.  Conflict when another program holds the sensor.
  [[nodiscard]] Result<void> take(Seat seat, PushedFrame frame, const Hello& hello);
  void note_refusal(Seat seat, const Error& error);
  void note_left_out(Seat seat);
  void note_clock(Seat seat, const std::optional<ClockEstimate>& estimate);

  [[nodiscard]] PushStatus status() const;

  /// For the device's thread: everything since the last call; waits at most `patience`.
  [[nodiscard]] std::vector<Capture> captures(Duration patience) { return queue_.take(patience); }

 private:
  struct Holder {
    Seat seat = 0;
    PushStatus status;
    SteadyTime sat_down{};
    std::optional<SteadyTime> last_frame;
    std::optional<std::uint64_t> last_count;  ///< The last number of the pusher's own count.
    /// True if something was refused after the last frame.
    bool refused_since = false;
  };
  [[nodiscard]] bool idle(const Holder& holder) const;
  [[nodiscard]] std::string silence_of(const Holder& holder) const;
  [[nodiscard]] bool advances(Timestamp captured) const;
  [[nodiscard]] std::uint64_t step_of(const PushedFrame& frame) const;

  const DeskOptions options_;
  RateReport refusals_{"pushed message refused"};
  Handover<Capture> queue_;
  mutable std::mutex mutex_;  ///< Guards everything below.
  std::optional<Holder> holder_;
  std::string departed_;  ///< How the last program left, for people.
  Seat last_seat_ = 0;
  std::size_t connections_ = 0;
  SteadyTime shut_until_{};
  std::uint64_t sequence_ = 0;
  std::optional<Timestamp> last_captured_;
  std::optional<Timestamp> refused_captured_;  ///< The previous frame's, if its time went back.
};

}  // namespace chorus::bridge
