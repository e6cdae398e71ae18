// People as MQTT payloads: JSON, metres, right-handed, +y up, as /frame.
//
//   {"id": 7, "slot": 0, "sequence": 12, "at": "1795246200123456789",
//    "joints": {"Head": {"place": [x, y, z], "orientation": [x, y, z, w]}, ...}}
//
// `at` is nanoseconds since 1970 (UTC).  Only tracked joints; an orientation only where it is
// measured.
#pragma once

#include <string>
#include <string_view>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::mqtt {

/// What a topic of a person who is there no longer ends with, and of the tracker itself.
inline constexpr std::string_view kGone = R"({"gone": true})";
inline constexpr std::string_view kOnline = "online";
inline constexpr std::string_view kOffline = "offline";

/// Positions to a hundredth of a millimetre.
[[nodiscard]] std::string encode(const outlet::TrackerFrame& frame,
                                 const outlet::TrackerBody& body);

/// PREFIX/people/ID and PREFIX/status
[[nodiscard]] std::string person_topic(std::string_view prefix, PersonId person);
[[nodiscard]] std::string status_topic(std::string_view prefix);

/// Whether others can subscribe to what is published below `prefix`: 1 to 256 bytes, no wildcard,
/// no control character, no empty level.
[[nodiscard]] bool is_topic(std::string_view prefix);

}  // namespace chorus::mqtt
