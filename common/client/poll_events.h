// The inputs and outputs of PollFsm as values: what happened when polling a sensor, and what to do
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

namespace chorus::client {

struct PollTimings {
  /// Sent as Prefer: wait.  Also how long a stream may be without frames before it counts as
  /// silent.
  Duration wait = std::chrono::seconds(2);
  /// An answer that takes longer than this, plus the time that the sensor was asked to wait, counts
  /// as a failure.
  Duration answer_slack = std::chrono::seconds(1);
  /// Usual shortest time between two requests.
  Duration min_interval = std::chrono::milliseconds(4);
  /// Time from one request to the next after an answer that came at once with nothing new.
  Duration idle_interval = std::chrono::milliseconds(10);
  Duration first_backoff = std::chrono::milliseconds(100);
  Duration max_backoff = std::chrono::seconds(1);
  Duration floor_interval = std::chrono::seconds(10);  ///< How often the floor plane is requested.
  bool stream = true;  ///< Use an event stream if the sensor offers one.

  bool operator==(const PollTimings&) const = default;
};

enum class SensorState {
  Connecting,  ///< The sensor has not delivered a frame yet.
  Live,
  Lost,     ///< The sensor has delivered before, but delivers nothing new now.
  Refused,  ///< The sensor answers, but not like a sensor; the last error says what is wrong.
};
[[nodiscard]] std::string_view name_of(SensorState state) noexcept;

enum class Resource { Frame, FloorPlane, KeptFrame, Clock };

// Events.
struct Started {};
struct Woke {};  ///< The time of a Sleep is over.
/// An answer to a request for the latest frame.  `captured` is set if the body was a readable
/// frame. Here and below, `rest` is how long not to read from this sensor, to make up for the cost
/// of reading.
struct FrameAnswered {
  int status = 0;
  std::string etag = {};
  std::optional<Timestamp> captured = {};
  Duration rest{0};
};
struct FloorAnswered {
  bool known = true;  ///< False after a server error, for example while the sensor has no plane.
};
struct KeptAnswered {
  bool there = false;  ///< True if the earlier frame was returned; it is then delivered.
  Duration rest{0};
};
struct ClockAnswered {
  /// Uncertainty of the current clock estimate; none: the sensor does not send its time.
  std::optional<Duration> uncertainty = {};
  bool doubtful = false;  ///< True if the answer contradicts the estimate: ask again at once.
};
/// Status 200, but the body is not a frame of this sensor, or the time of the frame is implausible.
struct Unreadable {
  Error error;
  Duration rest{0};
};
struct Failed {
  Error error;
};  ///< A request without an answer (refused, reset, timed out), or an error in handling one.
struct StreamFrame {
  std::uint64_t sequence = 0;
  Timestamp captured;
  /// True if the frame's time does not fit those of earlier frames: request the clock at once.
  bool odd = false;
};
struct StreamEnded {
  Error error;  ///< Unsupported: the sensor has no event stream that we can read.
};
using Event = std::variant<Started, Woke, FrameAnswered, FloorAnswered, KeptAnswered, ClockAnswered,
                           Unreadable, Failed, StreamFrame, StreamEnded>;

// Actions.
struct Send {
  Resource resource = Resource::Frame;
  std::string etag = {};       ///< For If-None-Match; empty: do not send that field.
  Duration wait{0};            ///< For Prefer: wait; zero: do not send that field.
  Duration deadline{0};        ///< Report Failed if there is no answer after this time.
  std::uint64_t sequence = 0;  ///< For a KeptFrame: the number of the frame.
};
struct Sleep {
  Duration duration{0};  ///< A later action replaces what is left of it.
};
using Action = std::variant<Send, Sleep>;

enum class StreamOrder { None, Open, Close };

/// A line for the log.  There is at most one a second per sensor, the latest.
struct Notice {
  bool warning = false;
  std::string event;  ///< "sensor live", "sensor lost", "sensor refused", "sensor not reached"
  std::string reason;
};

struct Step {
  std::optional<Action> action = {};  ///< None: the current request or sleep continues.
  bool deliver = false;               ///< True if the frame just received is new: deliver it.
  bool late = false;                  ///< True if a newer frame has already been delivered.
  StreamOrder stream = StreamOrder::None;
  std::optional<Notice> notice = {};
};

}  // namespace chorus::client
