// Interprets the HTTP answers of a sensor.  No socket, no state.
#pragma once

#include <memory>
#include <optional>

#include "common/http/client.h"
#include "common/resource/frame_resource.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/clock_estimate.h"
#include "common/time/ntp_status.h"
#include "fusion-server/poll/poll_fsm.h"

namespace chorus::poll {

struct FrameAnswer {
  Event event;
  std::shared_ptr<const resource::FrameResource> frame;  ///< Null unless the body is a frame.
};

/// Reads the answer to a request for a frame. For status 200 its event is Unreadable if the content
/// type is not a frame's, or the body is not a readable frame of the expected sensor. A frame in
/// world space may have any source, because fusion servers can be chained.
[[nodiscard]] FrameAnswer read_frame_answer(const http::ClientResponse& response,
                                            const SensorId& expected);

/// Reads the data of an event: a frame in JSON, which begins with a brace, or in Turtle, which
/// never does.
[[nodiscard]] Result<std::shared_ptr<const resource::FrameResource>> read_frame_event(
    std::string_view text, const SensorId& expected);

/// Reads the answer of /floor-plane; none when the sensor has none (any status but 200).  The error
/// says what is wrong with a document that is no floor plane.
[[nodiscard]] Result<std::optional<FloorPlane>> read_floor_answer(
    const http::ClientResponse& response);

/// Reads the answer of /clock, in JSON: what the host says of its own clock; none when the answer
/// is not such a document.
[[nodiscard]] std::optional<NtpStatus> read_clock_answer(const http::ClientResponse& response);

/// The four time stamps of the exchange; none if the answer has no Chorus-Clock header.
[[nodiscard]] std::optional<ClockExchange> exchange_of(const http::ClientResponse& response);

/// The frame with its times corrected to our clock by `clock`, and with `floor`; the floor of a
/// frame in world space is y = 0 instead.
[[nodiscard]] SensorFrame place_in_time(const resource::FrameResource& frame,
                                        const SensorId& sensor, Timestamp received,
                                        const std::optional<ClockEstimate>& clock,
                                        const std::optional<FloorPlane>& floor);

/// Why the pipeline cannot use a frame with this time (it is in the future, or very old); otherwise
/// none.
[[nodiscard]] std::optional<Error> untimely(const SensorFrame& frame);

}  // namespace chorus::poll
