// Reads one message of a pusher (proto/bridge.md).  No IO, no state.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "common/inertial/inertial_frame.h"
#include "services/sensor/device/bridge/hello.h"

namespace chorus::bridge {

/// The pusher's answer to our question for its time.
struct ClockAnswer {
  Timestamp sent;      ///< When we asked, by our clock; copied from the question.
  Timestamp received;  ///< When the question arrived, by the pusher's clock.
  Timestamp answered;  ///< When this answer was sent, by the pusher's clock.
};

struct PushedFrame {
  std::optional<std::uint64_t> sequence;  ///< The pusher's own frame number.
  Timestamp captured;                     ///< Capture time of all bodies, by the pusher's clock.
  /// In sensor space; bodies without joints are left out.
  std::vector<BodyFrame> bodies;
  /// The shape of each body according to the message's `world` (body_placing.h); without joints
  /// where there is none.
  std::vector<Skeleton<SensorSpace>> shapes;
  std::optional<FloorPlane> floor;
  /// Whether all landmarks in pixels lie outside the picture; none if there are too few to tell.
  std::optional<bool> outside_picture;
  std::size_t zeros = 0;  ///< Points at exactly 0, 0, 0, which are taken as not seen.
};

/// What worn inertial sensors say at one instant, in a world with +y up; times by the pusher's
/// clock.
struct PushedOrientations {
  std::optional<std::uint64_t> sequence;  ///< The pusher's own number.
  inertial::InertialFrame instant;        ///< Without source and sequence; checked.
};

using PushMessage = std::variant<Hello, ClockAnswer, PushedFrame, PushedOrientations>;

/// `hello`: the pusher's; null before it has arrived.  Unknown keys are ignored.  Errors say where
/// in the message the mistake is ("bodies[0].points[3]") and what is expected there.
[[nodiscard]] Result<PushMessage> read_push_message(std::string_view text, const Hello* hello);

}  // namespace chorus::bridge
