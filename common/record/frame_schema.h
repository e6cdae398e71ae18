// The JSON Schemas of our messages.  Recordings contain them, so that they are self-describing.
#pragma once

#include <string_view>

namespace chorus::record {

inline constexpr std::string_view kMetadataName = "chorus";

/// Its schema is proto/frame.schema.json.
inline constexpr std::string_view kFrameSchemaName = "chorus.Frame";

inline constexpr std::string_view kFloorSchemaName = "chorus.FloorPlane";
inline constexpr std::string_view kFloorSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "chorus.FloorPlane",
  "description": "n.x + d = 0 in sensor space, valid from this message on; unit normal, metres",
  "type": "object",
  "required": ["normalX", "normalY", "normalZ", "offset"],
  "properties": {
    "normalX": {"type": "number"}, "normalY": {"type": "number"}, "normalZ": {"type": "number"},
    "offset": {"type": "number"}
  }
})";

inline constexpr std::string_view kClockSchemaName = "chorus.ClockModel";
inline constexpr std::string_view kClockSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "chorus.ClockModel",
  "description": "What is added to a sensor's capture times to get the recorder's, valid from this message on",
  "type": "object",
  "required": ["sensor", "appliedNanoseconds"],
  "properties": {
    "sensor": {"type": "string"},
    "appliedNanoseconds": {"type": "string", "description": "added to its capture times"},
    "oursMinusTheirsNanoseconds": {"type": "string", "description": "the estimate when applied was last changed"},
    "uncertaintyNanoseconds": {"type": "string"}
  }
})";

inline constexpr std::string_view kRegistrationSchemaName = "chorus.Registration";
inline constexpr std::string_view kRegistrationSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "chorus.Registration",
  "description": "Where the sensors stand, valid from this message on: x_in_world = q x_in_sensor + (x, y, z); metres",
  "type": "object",
  "required": ["sensors"],
  "properties": {
    "version": {"type": "integer"},
    "verdict": {"enum": ["None", "Provisional", "Good", "Refused"]},
    "master": {"type": "string"},
    "sensors": {"type": "object", "additionalProperties": {
      "type": "object",
      "required": ["x", "y", "z", "qx", "qy", "qz", "qw"],
      "properties": {
        "x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"},
        "qx": {"type": "number"}, "qy": {"type": "number"}, "qz": {"type": "number"}, "qw": {"type": "number"}
      }
    }}
  }
})";

}  // namespace chorus::record
