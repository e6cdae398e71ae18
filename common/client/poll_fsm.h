// How one service is followed, as a state machine without I/O: takes events, returns the next
// action.
//
// At first it uses long polling (If-None-Match + Prefer: wait), which every sensor answers, and
// which shows what is wrong with a service that is not a sensor.  Once frames come, it opens an
// event stream in addition.  When the stream delivers, it replaces polling; then requests are used
// only for the clock, now and then for the floor plane, for frames that the stream left out, and
// for the newest frame if lost packets hold the stream up.  When a stream ends, falls silent or is
// refused, polling continues.  If nothing answers, it waits with a jittered exponential back-off.
// Time and randomness are arguments; the Asio shell (follower.h) carries out the actions and
// returns the answers.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/duration.h"
#include "common/client/backfill.h"
#include "common/client/poll_events.h"
#include "common/client/stream_rhythm.h"
#include "common/time/timestamp.h"

namespace chorus::client {

/// What there is to ask for beside the latest document.
struct Offer {
  std::string_view path = "frame";  ///< As DocumentKind::path.
  bool floor = true;                ///< A floor plane.
  bool kept = true;                 ///< Earlier documents, by their numbers.
};

/// `now` is a steady time since any origin; `jitter` in [0, 1) scales the back-off between half and
/// full.
class PollFsm {
 public:
  explicit PollFsm(PollTimings timings = {}, Offer offer = {}) : timings_(timings), offer_(offer) {}

  [[nodiscard]] Step resume(const Event& event, Duration now, double jitter);

  [[nodiscard]] SensorState state() const noexcept { return state_; }
  /// What is wrong at present; empty while the sensor is live.
  [[nodiscard]] const std::string& last_error() const noexcept { return last_error_; }
  [[nodiscard]] std::uint64_t failures() const noexcept { return failures_; }
  /// True while a request is under way.
  [[nodiscard]] bool asking() const noexcept { return asking_; }
  [[nodiscard]] bool streaming() const noexcept { return streaming_; }
  /// True while the clock is being requested because a frame's time did not fit.
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
  Step refuse(int status, double jitter);
  Step go_on(Duration now);
  [[nodiscard]] bool floor_is_due(Duration now) const;
  Action next_request(Duration now);
  Action next_frame();
  Action next_beside_stream(Duration now);
  Action after(Duration interval, Duration now, Duration rest = Duration{0});
  [[nodiscard]] SensorState gone() const;
  void became_live(Duration now);
  bool wants_stream(Duration now);
  void leave_stream(Duration now, Duration pause);
  [[nodiscard]] Step beside_stream(const FrameAnswered& answer, Duration now);
  [[nodiscard]] std::string refusal_words(int status) const;
  [[nodiscard]] bool was_taken_beside(Timestamp captured);
  void enter(SensorState state, std::string reason);
  std::optional<Notice> due_notice(Duration now);

  PollTimings timings_;
  Offer offer_;
  SensorState state_ = SensorState::Connecting;
  std::string last_error_;
  std::string etag_;
  std::optional<Timestamp> last_captured_;
  Duration sent_at_{0};
  Resource asked_ = Resource::Frame;
  bool asking_ = false;
  Duration asked_wait_{0};
  std::optional<Duration> floor_due_;  ///< When the floor plane is due; none: at once.
  bool floor_known_ = false;
  Duration floor_pause_{0};  ///< Grows when requests for the floor plane fail although frames come.
  int failures_in_row_ = 0;
  bool token_refused_ = false;  ///< By the last answer.
  std::uint64_t failures_ = 0;

  bool stream_asked_ = false;  ///< True while a stream is being opened or is open.
  bool streaming_ = false;     ///< True once the stream has delivered; it then replaces polling.
  Duration stream_due_{0};     ///< Earliest time to open the next stream.
  Duration stream_pause_{0};   ///< Pause after the last stream; it grows.
  Duration streamed_since_{0};
  Duration streamed_at_{0};
  Backfill backfill_;
  StreamRhythm rhythm_;
  /// Capture times of requested frames that the stream will still bring.
  std::deque<Timestamp> taken_beside_;
  Duration clock_due_{0};
  int clock_checks_ = 0;
  int clock_hurried_ = 0;  ///< Requests made in a hurry since the stream began or a clock was set.
  std::optional<Duration> clock_checked_at_;

  std::optional<Notice> pending_notice_;
  std::optional<Duration> noticed_at_;
};

}  // namespace chorus::client
