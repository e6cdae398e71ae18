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

inline constexpr std::string_view kOrientationsSchemaName = "chorus.Orientations";
inline constexpr std::string_view kOrientationsSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "chorus.Orientations",
  "description": "What worn inertial sensors said at one or more instants: /orientations as application/json. Hamilton quaternions from the sensor's axes to a space with +y up whose heading is the sensor's own; radians, m/s^2, rad/s.",
  "type": "object",
  "required": ["@type", "sequence", "capturedNanoseconds", "source", "instants"],
  "properties": {
    "@type": {"const": "Orientations"},
    "sequence": {"type": "integer", "minimum": 0},
    "captured": {"type": "string", "format": "date-time", "description": "of the newest instant"},
    "capturedNanoseconds": {"type": "string"},
    "source": {"type": "string"},
    "instants": {"type": "array", "minItems": 1, "maxItems": 100, "items": {
      "type": "object",
      "required": ["sequence", "capturedNanoseconds", "readings"],
      "properties": {
        "sequence": {"type": "integer", "minimum": 0},
        "capturedNanoseconds": {"type": "string"},
        "readings": {"type": "object", "description": "by the sensor's name", "additionalProperties": {
          "type": "object",
          "required": ["capturedNanoseconds"],
          "properties": {
            "capturedNanoseconds": {"type": "string"},
            "limb": {"type": "string"},
            "qx": {"type": "number"}, "qy": {"type": "number"}, "qz": {"type": "number"}, "qw": {"type": "number"},
            "magneticState": {"enum": ["undisturbed", "disturbed", "none"]},
            "battery": {"type": "number", "minimum": 0, "maximum": 1}
          }
        }}
      }
    }}
  }
})";

inline constexpr std::string_view kCalibrationSchemaName = "chorus.InertialCalibration";
inline constexpr std::string_view kCalibrationSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "chorus.InertialCalibration",
  "description": "How worn inertial sensors sit on a person, valid from this message on: world_from_limb = about_y(heading) inertial_from_sensor conj(limb_from_sensor); radians",
  "type": "object",
  "required": ["@type", "source", "madeNanoseconds", "calibrations"],
  "properties": {
    "@type": {"const": "InertialCalibration"},
    "source": {"type": "string"},
    "madeNanoseconds": {"type": "string"},
    "calibrations": {"type": "object", "description": "by the sensor's name", "additionalProperties": {
      "type": "object",
      "required": ["limb", "heading", "qx", "qy", "qz", "qw"],
      "properties": {
        "limb": {"type": "string"},
        "heading": {"type": "number"},
        "qx": {"type": "number"}, "qy": {"type": "number"}, "qz": {"type": "number"}, "qw": {"type": "number"},
        "covariance": {"type": "array", "items": {"type": "number"}, "description": "upper triangle by rows, of heading and mount [rad^2]"},
        "residual": {"type": "number"}, "predictionSigma": {"type": "number"}
      }
    }}
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

/// The text of the schema of this name, of those above and in skeleton_scene.h; empty: none has it.
[[nodiscard]] std::string_view schema_text(std::string_view name);

}  // namespace chorus::record
