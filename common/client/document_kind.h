// What following a service has to know of a kind of document, such as /frame, and what it yields.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "common/base/result.h"
#include "common/base/strong_id.h"
#include "common/resource/document.h"
#include "common/resource/media_type.h"
#include "common/sensor/sensor_frame.h"
#include "common/time/clock_estimate.h"
#include "common/time/timestamp.h"

namespace chorus::client {

using resource::Document;

struct DocumentKind {
  /// The resource, below the service's `/`: "frame".  The latest document is there, by conditional
  /// long polling and, if the service has one, as an event stream.
  std::string_view path;
  std::string_view kept;  ///< Where earlier ones are, by sequence: "frames/"; empty: nowhere.
  bool floor = false;     ///< Whether the service's floor plane is asked for, too.
  resource::Format preferred = resource::Format::Turtle;  ///< What it is read from fastest.
  /// Reads one.  Refuses what is not of `expected`, and any document that is not of this kind.
  Result<Document> (*read)(std::string_view text, resource::Format format,
                           const SensorId& expected) = nullptr;
};

/// A kind whose documents are read as values of this type.
template <class Value>
struct KindOf : DocumentKind {};

/// A document as it was delivered.  `Value` is what its kind reads.
template <class Value>
struct Arrived {
  SensorId source;  ///< FollowedService::id.
  std::shared_ptr<const Value>
      document;                        ///< As the source sent it, with times by its host's clock.
  Timestamp received;                  ///< By our clock.
  std::optional<ClockEstimate> clock;  ///< correction() of it makes their times ours.
  std::optional<FloorPlane> floor;     ///< The latest, if the kind has one.
};

using DeliverAny = std::function<void(Arrived<void>)>;

template <class Value>
[[nodiscard]] DeliverAny typed(std::function<void(Arrived<Value>)> deliver) {
  return [deliver = std::move(deliver)](Arrived<void> any) {
    deliver({std::move(any.source), std::static_pointer_cast<const Value>(std::move(any.document)),
             any.received, any.clock, any.floor});
  };
}

}  // namespace chorus::client
