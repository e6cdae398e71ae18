// How one sensor is followed, as a state machine without IO: events in, the next action out.
//
// First by long poll (If-None-Match + Prefer: wait), which every sensor answers, and which tells
// what is wrong with a service that is no sensor.  Once frames come, an event stream is opened
// beside it; when that delivers, it takes over, and requests only keep the clock, ask for the floor
// plane now and then, fetch what the stream left out, and the newest frame where lost packets hold
// it up.  A stream that ends, falls silent or is refused leaves the polling as it was.  Jittered
// exponential back-off when nothing answers.  Time and randomness are arguments; the Asio shell
// (follower.h) executes the actions and feeds the answers back.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "common/base/duration.h"
#include "common/time/timestamp.h"
#include "fusion-server/poll/backfill.h"
#include "fusion-server/poll/poll_events.h"
#include "fusion-server/poll/stream_rhythm.h"

namespace chorus::poll {

/// `now` is a steady time from any origin; `jitter` in [0, 1) scales back-off between half and
/// whole.
class PollFsm {
 public:
  explicit PollFsm(PollTimings timings = {}) : timings_(timings) {}

  [[nodiscard]] Step resume(const Event& event, Duration now, double jitter);

  [[nodiscard]] SensorState state() const noexcept { return state_; }
  /// What is wrong now; empty while the sensor is live.
  [[nodiscard]] const std::string& last_error() const noexcept { return last_error_; }
  [[nodiscard]] std::uint64_t failures() const noexcept { return failures_; }
  /// A request is under way.
  [[nodiscard]] bool asking() const noexcept { return asking_; }
  [[nodiscard]] bool streaming() const noexcept { return streaming_; }
  /// The clock is being asked for because a frame's time did not fit.
  [[nodiscard]] bool checking_clock() const noexcept { return clock_checks_ > 0; }

 private:
  Step on(const Started& event, Duration now, double jitter);
  Step on(const Woke& event, Duration now, double jitter);
  Step on(const FrameAnswered& answer, Duration now, double jitter);
  Step on(const FloorAnswered& answer, Duration now, double jitter);
  Step on(const KeptAnswered& answer, Duration now, double jitter);
  Step on(const ClockAnswered& answer, Duration now, double jitter);
  Step on(const Unreadable& body, Duration now, double jitter);
  Step on(const Failed& failed, Duration now, double jitter);
  Step on(const StreamFrame& frame, Duration now, double jitter);
  Step on(const StreamEnded& end, Duration now, double jitter);

  Step fail(SensorState state, std::string reason, double jitter);
  Step go_on(Duration now);
  Action next_request(Duration now);
  Action next_frame();
  Action next_beside_stream(Duration now);
  Action after(Duration interval, Duration now, Duration rest = Duration{0});
  [[nodiscard]] SensorState gone() const;
  void became_live(Duration now);
  bool wants_stream(Duration now);
  void leave_stream(Duration now, Duration pause);
  [[nodiscard]] Step beside_stream(const FrameAnswered& answer, Duration now);
  [[nodiscard]] bool was_taken_beside(Timestamp captured);
  void enter(SensorState state, std::string reason);
  std::optional<Notice> due_notice(Duration now);

  PollTimings timings_;
  SensorState state_ = SensorState::Connecting;
  std::string last_error_;
  std::string etag_;
  std::optional<Timestamp> last_captured_;
  Duration sent_at_{0};
  Resource asked_ = Resource::Frame;
  bool asking_ = false;
  Duration asked_wait_{0};
  std::optional<Duration> floor_due_;  ///< Empty: at once.
  bool floor_known_ = false;
  Duration floor_pause_{0};  ///< After floor requests that failed while frames were good.
  int failures_in_row_ = 0;
  std::uint64_t failures_ = 0;

  bool stream_asked_ = false;  ///< Opening or open.
  bool streaming_ = false;     ///< It has delivered, and replaces polling.
  Duration stream_due_{0};     ///< Not to be opened before.
  Duration stream_pause_{0};   ///< After the last one.
  Duration streamed_since_{0};
  Duration streamed_at_{0};
  Backfill backfill_;
  StreamRhythm rhythm_;
  std::deque<Timestamp> taken_beside_;  ///< Frames that the stream is still to bring.
  Duration clock_due_{0};
  int clock_checks_ = 0;
  std::optional<Duration> clock_checked_at_;

  std::optional<Notice> pending_notice_;
  std::optional<Duration> noticed_at_;
};

}  // namespace chorus::poll
