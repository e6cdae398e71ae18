// The inputs and outputs of PollFsm as values: what happened to a sensor's poll, and what to do
// next.
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
  Duration wait = std::chrono::seconds(2);  ///< Prefer: wait; also until a sensor is silent.
  /// An answer later than wait + this counts as a failure.
  Duration answer_slack = std::chrono::seconds(1);
  /// Least time between two requests, whatever the answers.
  Duration min_interval = std::chrono::milliseconds(4);
  /// Pause after an immediate answer without anything new.
  Duration idle_interval = std::chrono::milliseconds(10);
  Duration first_backoff = std::chrono::milliseconds(100);
  Duration max_backoff = std::chrono::seconds(1);
  Duration floor_interval = std::chrono::seconds(10);  ///< How often the floor plane is requested.
  bool stream = true;  ///< Use an event stream when the sensor has one.

  bool operator==(const PollTimings&) const = default;
};

enum class SensorState {
  Connecting,  ///< Has not delivered a frame yet.
  Live,
  Lost,     ///< Has delivered before, but does not answer now.
  Refused,  ///< Answers, but not like a sensor: the last error says what is wrong.
};
[[nodiscard]] std::string_view name_of(SensorState state) noexcept;

enum class Resource { Frame, FloorPlane, KeptFrame, Clock };

// Events.
struct Started {};
struct Woke {};  ///< A Sleep is over.
/// An answer to a request for the latest frame.  `captured` is set when its body was a readable
/// frame.  Here and below, `rest`: how long to pause reading from this sensor to offset the cost.
struct FrameAnswered {
  int status = 0;
  std::string etag = {};
  std::optional<Timestamp> captured = {};
  Duration rest{0};
};
struct FloorAnswered {
  bool known = true;  ///< False when it says "not yet"; a sensor need not have a floor.
};
struct KeptAnswered {
  bool there = false;  ///< An earlier frame was returned; it is delivered.
  Duration rest{0};
};
struct ClockAnswered {
  /// Of the current clock estimate; none: the sensor sends no time.
  std::optional<Duration> uncertainty = {};
  bool doubtful = false;  ///< It contradicts the estimate: ask again at once.
};
/// Status 200, but the body, or an event, is not a frame of this sensor.
struct Unreadable {
  Error error;
  Duration rest{0};
};
struct Failed {
  Error error;
};  ///< A request without an answer: refused, reset, timed out.
struct StreamFrame {
  std::uint64_t sequence = 0;
  Timestamp captured;
  bool odd = false;  ///< Its time does not fit the clock estimate: request the clock at once.
};
struct StreamEnded {
  Error error;  ///< Unsupported: this sensor has no event stream that we can read.
};
using Event = std::variant<Started, Woke, FrameAnswered, FloorAnswered, KeptAnswered, ClockAnswered,
                           Unreadable, Failed, StreamFrame, StreamEnded>;

// Actions.
struct Send {
  Resource resource = Resource::Frame;
  std::string etag = {};       ///< For If-None-Match; empty: do not send it.
  Duration wait{0};            ///< For Prefer: wait; zero: do not send it.
  Duration deadline{0};        ///< If there is no answer after this time, report Failed.
  std::uint64_t sequence = 0;  ///< For a KeptFrame.
};
struct Sleep {
  Duration duration{0};  ///< A later action replaces the rest of it.
};
using Action = std::variant<Send, Sleep>;

enum class StreamOrder { None, Open, Close };

/// A line for the log; at most one a second per sensor, the latest one.
struct Notice {
  bool warning = false;
  std::string event;  ///< "sensor live", "sensor lost", "sensor refused"
  std::string reason;
};

struct Step {
  std::optional<Action> action = {};  ///< None: the current request or sleep continues.
  bool deliver = false;               ///< The frame just received is new: deliver it.
  bool late = false;                  ///< A newer one has already been delivered.
  StreamOrder stream = StreamOrder::None;
  std::optional<Notice> notice = {};
};

}  // namespace chorus::poll
