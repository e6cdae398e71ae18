// Receives pushed frames: one pusher at a time holds the sensor, and its frames go to the device's
// thread.  Also reports a human-readable state.  Thread-safe, no IO.
//
// A pusher holds the sensor from its hello until it leaves.  If it has pushed no frame for
// `yields_after`, another pusher may take over.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <variant>

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

/// What the desk knows about a pusher.
struct Pusher {
  std::string name;
  std::string layout;
  std::string via;      ///< "WebSocket", "HTTP POST" or "local socket".
  std::string address;  ///< The pusher's address; empty for a local socket.
};

struct PushStatus {
  std::string state;   ///< "waiting" (for a pusher), "silent" or "live".
  std::string reason;  ///< Human-readable: why the state is not live.
  std::optional<Pusher> pusher;
  Timestamp since{};          ///< When the pusher took the sensor.
  std::uint64_t frames = 0;   ///< Frames accepted from this pusher.
  std::uint64_t refused = 0;  ///< Messages of this pusher that were refused.
  /// Frames of this pusher beyond the maximum rate, or sent before its clock was known.
  std::uint64_t left_out = 0;
  std::string last_error;  ///< The error for the last refused message.
  std::string doubt;       ///< What is probably wrong although frames are taken; empty: nothing.
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
  using Seat = std::uint64_t;   ///< A new number for each pusher that takes the sensor; never 0.
  using Guest = std::uint64_t;  ///< A new number for each connection.

  explicit PushDesk(DeskOptions options);

  [[nodiscard]] const DeskOptions& options() const { return options_; }
  [[nodiscard]] Timestamp now() const { return options_.clock->now(); }
  [[nodiscard]] SteadyTime steady_now() const { return options_.steady_now(); }

  // A connection that has not said hello takes nobody's place: of each way in, four times
  // max_pushers may be silent, and for one more the oldest of them leaves.

  /// A new connection by this way ("WebSocket", "local socket").  Unavailable just after a flood,
  /// or while many that have to leave are still open.
  [[nodiscard]] Result<Guest> connect(const std::string& via);
  /// It has said hello.
  void greeted(Guest guest);
  void disconnect(Guest guest);
  /// True if it said nothing and has to make room for another.
  [[nodiscard]] bool must_leave(Guest guest) const;
  /// Call this when a pusher was disconnected for flooding: for a second, no new connection is
  /// accepted.
  void shut_for_a_moment();

  /// Gives the sensor to this pusher.  Conflict while another pusher is pushing; the error names
  /// that pusher.
  [[nodiscard]] Result<Seat> sit_down(const Pusher& pusher);
  [[nodiscard]] bool sits(Seat seat) const;
  void leave(Seat seat, std::string_view why);

  /// Takes a frame whose times are by this host's clock.  Refuses it when its capture time does not
  /// advance, unless a clock was set: that is assumed when the time steps back by more than a
  /// second, or by less and the next frame continues from there.  Conflict when another pusher
  /// holds the sensor.
  [[nodiscard]] Result<void> take(Seat seat, PushedFrame frame, const Hello& hello);
  /// Seat 0: a pusher whose hello was refused.
  /// As take(), for what worn sensors say; their times advance on their own.
  [[nodiscard]] Result<void> take(Seat seat, PushedOrientations pushed);
  void note_refusal(Seat seat, const Error& error);
  void note_left_out(Seat seat);
  void note_doubt(Seat seat, const std::string& doubt);
  void note_clock(Seat seat, const std::optional<ClockEstimate>& estimate);

  [[nodiscard]] PushStatus status() const;

  using Pushed = std::variant<Capture, inertial::InertialFrame>;
  /// For the device's thread: all that was taken since the last call; waits at most `patience` for
  /// the first one.
  [[nodiscard]] std::vector<Pushed> pushed(Duration patience) { return queue_.take(patience); }

 private:
  struct Holder {
    Seat seat = 0;
    PushStatus status;
    SteadyTime sat_down{};
    std::optional<SteadyTime> last_frame;
    std::optional<std::uint64_t> last_count;  ///< The number that the pusher gave its last frame.
    bool sent_frame = false;                  ///< Not only orientations.
    bool hello_had_floor = false;             ///< At the last frame.
    /// True if a message was refused after the last frame.
    bool refused_since = false;
  };
  /// The numbers and times of what was taken, of frames or of orientations.
  struct Line {
    std::uint64_t sequence = 0;
    std::optional<Timestamp> last_captured;
    /// Capture time of the previous one, if that was refused because its time did not advance.
    std::optional<Timestamp> refused_captured;

    [[nodiscard]] bool advances(Timestamp captured) const;
  };
  [[nodiscard]] bool idle(const Holder& holder) const;
  [[nodiscard]] std::string silence_of(const Holder& holder) const;
  [[nodiscard]] Result<void> check_turn(Seat seat, Line& line, Timestamp captured) const;
  void note_taken();
  [[nodiscard]] std::uint64_t step_of(const PushedFrame& frame) const;

  const DeskOptions options_;
  RateReport refusals_{"pushed message refused"};
  Handover<Pushed> queue_;
  mutable std::mutex mutex_;  ///< Guards everything below.
  std::optional<Holder> holder_;
  std::string departed_;     ///< Human-readable: how the last pusher left.
  std::string turned_away_;  ///< Why the last hello was refused, if no pusher came in since.
  Seat last_seat_ = 0;
  struct Silent {
    std::string via;
    bool leaves = false;
  };
  std::map<Guest, Silent> silent_;  ///< Connections that have not said hello, oldest first.
  Guest last_guest_ = 0;
  SteadyTime shut_until_{};
  Line frames_;
  Line instants_;
};

}  // namespace chorus::bridge
