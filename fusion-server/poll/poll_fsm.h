// How one sensor is followed, as a state machine without I/O: events in, the next action out.
//
// At first by long polling (If-None-Match + Prefer: wait), which every sensor answers, and which
// reveals what is wrong with a service that is no sensor.  Once frames come, an event stream is
// opened in addition; when it delivers, it takes over, and requests are only used for the clock,
// for the floor plane at times, for frames that the stream left out, and for the newest frame if
// lost packets hold it up.  When a stream ends, falls silent or is refused, polling goes on.  If
// nothing answers, a jittered exponential back-off applies.  Time and randomness are arguments; the
// Asio shell (follower.h) executes the actions and returns the answers.
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

/// `now` is a steady time from any origin; `jitter` in [0, 1) scales the back-off between half and
/// full.
class PollFsm {
 public:
  explicit PollFsm(PollTimings timings = {}) : timings_(timings) {}

  [[nodiscard]] Step resume(const Event& event, Duration now, double jitter);

  [[nodiscard]] SensorState state() const noexcept { return state_; }
  /// What is wrong at present; empty while the sensor is live.
  [[nodiscard]] const std::string& last_error() const noexcept { return last_error_; }
  [[nodiscard]] std::uint64_t failures() const noexcept { return failures_; }
  /// A request is under way.
  [[nodiscard]] bool asking() const noexcept { return asking_; }
  [[nodiscard]] bool streaming() const noexcept { return streaming_; }
  /// The clock is being requested because a frame's time did not fit.
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
  std::optional<Duration> floor_due_;  ///< Empty: immediately.
  bool floor_known_ = false;
  Duration floor_pause_{0};  ///< Grows when floor requests fail although frames are good.
  int failures_in_row_ = 0;
  std::uint64_t failures_ = 0;

  bool stream_asked_ = false;  ///< A stream is being opened or is open.
  bool streaming_ = false;     ///< The stream has delivered, and replaces polling.
  Duration stream_due_{0};     ///< Earliest time to open it.
  Duration stream_pause_{0};   ///< Pause after the last stream.
  Duration streamed_since_{0};
  Duration streamed_at_{0};
  Backfill backfill_;
  StreamRhythm rhythm_;
  std::deque<Timestamp> taken_beside_;  ///< Requested frames that the stream will still bring.
  Duration clock_due_{0};
  int clock_checks_ = 0;
  std::optional<Duration> clock_checked_at_;

  std::optional<Notice> pending_notice_;
  std::optional<Duration> noticed_at_;
};

}  // namespace chorus::poll
