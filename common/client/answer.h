// Interprets the HTTP answers of a service that is followed.  No socket, no state.
#pragma once

#include <optional>

#include "common/client/document_kind.h"
#include "common/client/poll_events.h"
#include "common/http/client.h"
#include "common/time/clock_estimate.h"
#include "common/time/ntp_status.h"

namespace chorus::client {

struct Answer {
  Event event;
  Document document;  ///< Without a value unless the body is a document of the kind.
};

/// Reads the answer to a request for a document. For status 200 its event is Unreadable if the
/// content type is not one that the kind has, or the body cannot be read as a document of the
/// expected source.
[[nodiscard]] Answer read_answer(const http::ClientResponse& response, const DocumentKind& kind,
                                 const SensorId& expected);

/// Reads the data of an event: a document in JSON, which begins with a brace, or in Turtle, which
/// never does.
[[nodiscard]] Result<Document> read_event(std::string_view text, const DocumentKind& kind,
                                          const SensorId& expected);

/// Reads the answer of /floor-plane; none when the sensor has none (any status but 200).  The error
/// says what is wrong with a document that is no floor plane.
[[nodiscard]] Result<std::optional<FloorPlane>> read_floor_answer(
    const http::ClientResponse& response);

/// Reads the answer of /clock, in JSON: what the host says of its own clock; none when the answer
/// is not such a document.
[[nodiscard]] std::optional<NtpStatus> read_clock_answer(const http::ClientResponse& response);

/// The four time stamps of the exchange; none if the answer has no Chorus-Clock header.
[[nodiscard]] std::optional<ClockExchange> exchange_of(const http::ClientResponse& response);

/// When a document was captured, and when it arrived, both by our clock.
struct Dated {
  std::uint64_t sequence = 0;
  Timestamp captured;
  Timestamp received;
};

/// Why nobody can use a document with this time (it is in the future, or very old); otherwise none.
[[nodiscard]] std::optional<Error> untimely(const Dated& document);

}  // namespace chorus::client
