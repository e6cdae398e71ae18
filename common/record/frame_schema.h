// The JSON Schemas of our messages.  Recordings contain them, so that they are self-describing.
#pragma once

#include <string_view>

namespace chorus::record {

inline constexpr std::string_view kMetadataName = "chorus";

inline constexpr std::string_view kFrameSchemaName = "chorus.Frame";
inline constexpr std::string_view kFrameSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "chorus.Frame",
  "description": "All bodies one sensor saw at one instant: /frame as application/json. Metres, right-handed, +y up.",
  "type": "object",
  "required": ["sequence", "capturedNanoseconds", "source", "space", "bodies"],
  "properties": {
    "@type": {"const": "Frame", "description": "may be left out; never anything else"},
    "sequence": {"type": "integer", "minimum": 0},
    "captured": {"type": "string", "format": "date-time", "description": "UTC of capture"},
    "capturedNanoseconds": {"type": "string", "description": "the same, nanoseconds since the Unix epoch"},
    "source": {"type": "string", "description": "sensor id"},
    "space": {"enum": ["SensorSpace", "WorldSpace"]},
    "sensors": {"type": "array", "items": {"type": "string"}, "description": "fused: the sensors that have a place"},
    "bodies": {"type": "array", "items": {
      "type": "object",
      "required": ["bodyId", "joints"],
      "properties": {
        "bodyId": {"description": "integer; beyond 2^53 its digits as a string"},
        "sidesConfidence": {"type": "number", "minimum": 0, "maximum": 1, "description": "probability that left and right are not exchanged"},
        "carriedFor": {"type": "number", "minimum": 0, "description": "for how long no sensor has seen the person, who is where they are expected [s]; absent: seen"},
        "smoothedOver": {"type": "number", "minimum": 0, "description": "for how long after the instant what sensors saw was taken into account [s]; absent: what was known at the instant"},
        "slot": {"type": "integer", "minimum": 0, "description": "the person's number in every output of the tracker"},
        "captured": {"type": "string"},
        "capturedNanoseconds": {"type": "string"},
        "joints": {"type": "object", "description": "by Kinect v2 joint name", "additionalProperties": {
          "type": "object",
          "required": ["state"],
          "properties": {
            "x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"},
            "qx": {"type": "number"}, "qy": {"type": "number"}, "qz": {"type": "number"}, "qw": {"type": "number"},
            "rayX": {"type": "number"}, "rayY": {"type": "number"}, "rayZ": {"type": "number", "description": "instead of x, y, z: a unit vector from the sensor towards the joint"},
            "variance": {"type": "number", "minimum": 0, "description": "mean variance per axis [m^2]"},
            "cxx": {"type": "number"}, "cxy": {"type": "number"}, "cxz": {"type": "number"}, "cyy": {"type": "number"}, "cyz": {"type": "number"},
            "czz": {"type": "number", "description": "covariance of the position [m^2], or of the ray [rad^2]"},
            "contributors": {"type": "array", "items": {"type": "string"}, "description": "fused: the sensors this joint came from; empty: where it is expected"},
            "shares": {"type": "array", "items": {"type": "number", "minimum": 0, "maximum": 1}, "description": "fused: by how much each contributor determines the position, in the order of their ids; absent: one has all, or not known"},
            "age": {"type": "number", "minimum": 0, "description": "fused: for how long no sensor has contributed to the joint [s]; absent: one does"},
            "state": {"enum": ["Tracked", "Inferred", "NotTracked"]}
          }
        }}
      }
    }}
  }
})";

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
