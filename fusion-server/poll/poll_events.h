// What a sensor's poll is told and what it wants done: the values that go into PollFsm and come
// out.
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
  /// An answer later than wait + this is a failure.
  Duration answer_slack = std::chrono::seconds(1);
  /// Between two requests, whatever the answers.
  Duration min_interval = std::chrono::milliseconds(4);
  /// After an immediate answer that brought nothing new.
  Duration idle_interval = std::chrono::milliseconds(10);
  Duration first_backoff = std::chrono::milliseconds(100);
  Duration max_backoff = std::chrono::seconds(1);
  Duration floor_interval = std::chrono::seconds(10);  ///< How often the floor plane is asked for.
  bool stream = true;  ///< Use an event stream when the sensor has one.

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
/// frame.  Here and below, `rest`: how long to pause reading from this sensor, for what it cost.
struct FrameAnswered {
  int status = 0;
  std::string etag = {};
  std::optional<Timestamp> captured = {};
  Duration rest{0};
};
struct FloorAnswered {
  bool known = true;  ///< False when it says "not yet"; a sensor without a floor is a sensor too.
};
struct KeptAnswered {
  bool there = false;  ///< A frame of the past; it is delivered.
  Duration rest{0};
};
struct ClockAnswered {
  /// Of the estimate now; none: the sensor tells no time.
  std::optional<Duration> uncertainty = {};
  bool doubtful = false;  ///< It contradicts the estimate: ask again at once.
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
  std::optional<Action> action = {};  ///< None: the request or sleep in progress continues.
  bool deliver = false;               ///< The frame just answered is new: pass it on.
  bool late = false;                  ///< A newer one has been delivered already.
  StreamOrder stream = StreamOrder::None;
  std::optional<Notice> notice = {};
};

}  // namespace chorus::poll
