// What an HTTP answer of a sensor means.  No socket, no state.
#pragma once

#include <memory>
#include <optional>

#include "common/http/client.h"
#include "common/resource/frame_resource.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/clock_estimate.h"
#include "fusion-server/poll/poll_fsm.h"

namespace chorus::poll {

struct FrameAnswer {
  Event event;
  std::shared_ptr<const resource::FrameResource> frame;  ///< Null unless the body was a frame.
};

/// Refuses, as Unreadable: a content type that is no frame, an unreadable frame, a frame of another
/// sensor.  A frame in world space may have any source: fusion servers can be chained.
[[nodiscard]] FrameAnswer read_frame_answer(const http::ClientResponse& response,
                                            const SensorId& expected);

/// The data of an event: a frame in JSON, which begins with a brace, or in Turtle, which never
/// does.
[[nodiscard]] Result<std::shared_ptr<const resource::FrameResource>> read_frame_event(
    std::string_view text, const SensorId& expected);

/// /floor-plane; none when there is none or it cannot be read.
[[nodiscard]] std::optional<FloorPlane> read_floor_answer(const http::ClientResponse& response);

/// The four stamps, when the answer carries Chorus-Clock.
[[nodiscard]] std::optional<ClockExchange> exchange_of(const http::ClientResponse& response);

/// The frame by our clock, moved by `shift`, with its floor: y = 0 in world space.
[[nodiscard]] SensorFrame place_in_time(const resource::FrameResource& frame,
                                        const SensorId& sensor, Timestamp received, Duration shift,
                                        const std::optional<FloorPlane>& floor);

/// Why no pipeline can use a frame with this time: it is in the future, or very old.
[[nodiscard]] std::optional<Error> untimely(const SensorFrame& frame);

}  // namespace chorus::poll
