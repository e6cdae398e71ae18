// How one sensor is polled, as a state machine without IO: events in, the next action out.
//
// Long poll of the sensor's frame (If-None-Match + Prefer: wait), its floor plane now and then,
// jittered exponential back-off when it fails.  Time and randomness are arguments; the Asio shell
// (poller.h) executes the actions and feeds the answers back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "common/base/duration.h"
#include "common/base/error.h"
#include "common/time/timestamp.h"

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
  Duration max_backoff = std::chrono::seconds(5);
  Duration floor_interval = std::chrono::seconds(10);  ///< How often the floor plane is asked for.

  bool operator==(const PollTimings&) const = default;
};

enum class SensorState {
  Connecting,  ///< Never delivered a frame yet.
  Live,
  Lost,     ///< Delivered before, does not answer now.
  Refused,  ///< Answers, but not as a sensor: the last error says what is wrong.
};
[[nodiscard]] std::string_view name_of(SensorState state) noexcept;

enum class Resource { Frame, FloorPlane };

// Events.
struct Started {};
struct Woke {};  ///< A Sleep is over.
/// An HTTP answer.  `captured` is set when the body was a readable frame.
struct FrameAnswered {
  int status = 0;
  std::string etag = {};
  std::optional<Timestamp> captured = {};
};
struct FloorAnswered {};  ///< Any answer; a sensor without a floor plane is a sensor too.
struct Unreadable {
  Error error;
};  ///< 200, but the body is not a frame of this sensor.
struct Failed {
  Error error;
};  ///< No answer: refused, reset, timed out.
using Event = std::variant<Started, Woke, FrameAnswered, FloorAnswered, Unreadable, Failed>;

// Actions.
struct Send {
  Resource resource = Resource::Frame;
  std::string etag = {};  ///< For If-None-Match; empty: none.
  Duration wait{0};       ///< For Prefer: wait; zero: none.
  Duration deadline{0};   ///< Without an answer by then, report Failed.
};
struct Sleep {
  Duration duration{0};
};
using Action = std::variant<Send, Sleep>;

/// A line for the log; at most one a second per sensor, the latest wins.
struct Notice {
  bool warning = false;
  std::string event;  ///< "sensor live", "sensor lost", "sensor refused"
  std::string reason;
};

struct Step {
  Action action;
  bool deliver = false;  ///< The frame just answered is news: hand it on.
  std::optional<Notice> notice = {};
};

/// `now` is a steady time from any origin; `jitter` in [0, 1) scales back-off between half and
/// whole.
class PollFsm {
 public:
  explicit PollFsm(PollTimings timings = {}) : timings_(timings) {}

  [[nodiscard]] Step resume(const Event& event, Duration now, double jitter);

  [[nodiscard]] SensorState state() const noexcept { return state_; }
  [[nodiscard]] const std::string& last_error() const noexcept { return last_error_; }
  [[nodiscard]] std::uint64_t failures() const noexcept { return failures_; }
  [[nodiscard]] std::uint64_t repeats() const noexcept { return repeats_; }

 private:
  Step on_frame(const FrameAnswered& answer, Duration now, double jitter);
  Step fail(SensorState state, std::string reason, double jitter);
  Action next_request(Duration now);
  Action after(Duration interval, Duration now);
  void enter(SensorState state, std::string reason);
  std::optional<Notice> due_notice(Duration now);

  PollTimings timings_;
  SensorState state_ = SensorState::Connecting;
  std::string last_error_;
  std::string etag_;
  std::optional<Timestamp> last_captured_;
  Duration sent_at_{0};
  std::optional<Duration> floor_due_;  ///< Empty: at once.
  Duration asked_wait_{0};
  int failures_in_row_ = 0;
  std::uint64_t failures_ = 0;
  std::uint64_t repeats_ = 0;  ///< Answers without news that came before the wait was over.
  std::optional<Notice> pending_notice_;
  std::optional<Duration> noticed_at_;
};

}  // namespace chorus::poll
