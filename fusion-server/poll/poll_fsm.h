// How one sensor is followed, as a state machine without IO: events in, the next action out.
//
// First by long poll (If-None-Match + Prefer: wait), which every sensor answers: it says what is
// wrong with one that is none.  Once frames come, an event stream is opened beside it; when that
// delivers, it takes over, and the requests only keep the clock, ask for the floor plane now and
// then and fetch what the stream left out.  A stream that ends, falls silent or is refused leaves
// the polling as it was.  Jittered exponential back-off when nothing answers.  Time and randomness
// are arguments; the Asio shell (follower.h) executes the actions and feeds the answers back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "common/base/duration.h"
#include "common/base/error.h"
#include "common/time/timestamp.h"
#include "fusion-server/poll/backfill.h"

namespace chorus::poll {

struct PollTimings {
  Duration wait = std::chrono::seconds(2);  ///< Prefer: wait; also when a silent sensor is noticed.
  Duration answer_slack =
      std::chrono::seconds(1);  ///< An answer later than wait + this is a failure.
  Duration min_interval =
      std::chrono::milliseconds(4);  ///< Between two requests, whatever they answer.
  Duration idle_interval =
      std::chrono::milliseconds(10);  ///< After an answer at once that brought nothing new.
  Duration first_backoff = std::chrono::milliseconds(100);
  Duration max_backoff = std::chrono::seconds(1);
  Duration floor_interval = std::chrono::seconds(10);  ///< How often the floor plane is asked for.
  bool stream = true;  ///< Follow by event stream where a sensor has one.

  bool operator==(const PollTimings&) const = default;
};

enum class SensorState {
  Connecting,  ///< Never delivered a frame yet.
  Live,
  Lost,     ///< Delivered before, does not answer now.
  Refused,  ///< Answers, but not as a sensor: the last error says what is wrong.
};
[[nodiscard]] std::string_view name_of(SensorState state) noexcept;

enum class Resource { Frame, FloorPlane, KeptFrame, Clock };

// Events.
struct Started {};
struct Woke {};  ///< A Sleep is over.
/// An answer to a request for the latest frame.  `captured` is set when the body was a readable
/// one.  Here and below, `rest`: how long the sensor's reading has to pause, for what it cost.
struct FrameAnswered {
  int status = 0;
  std::string etag = {};
  std::optional<Timestamp> captured = {};
  Duration rest{0};
};
struct FloorAnswered {
  bool known = true;  ///< Not when it says "not yet"; a sensor without a floor is a sensor too.
};
struct KeptAnswered {
  bool there = false;  ///< A frame of the past; it is delivered.
  Duration rest{0};
};
struct ClockAnswered {
  std::optional<Duration> uncertainty = {};  ///< Of the estimate now; none: it tells no time.
  bool doubtful = false;                     ///< It contradicts the estimate: ask again at once.
};
/// 200, but the body, or an event, is not a frame of this sensor.
struct Unreadable {
  Error error;
  Duration rest{0};
};
struct Failed {
  Error error;
};  ///< No answer to a request: refused, reset, timed out.
struct StreamFrame {
  std::uint64_t sequence = 0;
  Timestamp captured;
  bool odd = false;  ///< Its time does not fit the clock estimate: ask for the clock at once.
};
struct StreamEnded {
  Error error;  ///< Unsupported: this sensor has no event stream, or none that we can read.
};
using Event = std::variant<Started, Woke, FrameAnswered, FloorAnswered, KeptAnswered, ClockAnswered,
                           Unreadable, Failed, StreamFrame, StreamEnded>;

// Actions.
struct Send {
  Resource resource = Resource::Frame;
  std::string etag = {};       ///< For If-None-Match; empty: none.
  Duration wait{0};            ///< For Prefer: wait; zero: none.
  Duration deadline{0};        ///< Without an answer by then, report Failed.
  std::uint64_t sequence = 0;  ///< Of a KeptFrame.
};
struct Sleep {
  Duration duration{0};  ///< A later action replaces what is left of it.
};
using Action = std::variant<Send, Sleep>;

enum class StreamOrder { None, Open, Close };

/// A line for the log; at most one a second per sensor, the latest wins.
struct Notice {
  bool warning = false;
  std::string event;  ///< "sensor live", "sensor lost", "sensor refused"
  std::string reason;
};

struct Step {
  std::optional<Action> action = {};  ///< None: the request or sleep under way goes on.
  bool deliver = false;               ///< The frame just answered is news: hand it on.
  StreamOrder stream = StreamOrder::None;
  std::optional<Notice> notice = {};
};

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
  Action next_beside_stream(Duration now);
  Action after(Duration interval, Duration now, Duration rest = Duration{0});
  [[nodiscard]] SensorState gone() const;
  void became_live(Duration now);
  bool wants_stream(Duration now);
  void leave_stream(Duration now, Duration pause);
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
  Duration floor_pause_{0};  ///< After floor requests that failed beside good frames.
  int failures_in_row_ = 0;
  std::uint64_t failures_ = 0;

  bool stream_asked_ = false;  ///< Opening or open.
  bool streaming_ = false;     ///< It has delivered, and is what we live on.
  Duration stream_due_{0};     ///< Not to be opened before.
  Duration stream_pause_{0};   ///< After the last one.
  Duration streamed_since_{0};
  Duration streamed_at_{0};
  Backfill backfill_;
  Duration clock_due_{0};
  int clock_checks_ = 0;
  std::optional<Duration> clock_checked_at_;

  std::optional<Notice> pending_notice_;
  std::optional<Duration> noticed_at_;
};

}  // namespace chorus::poll
