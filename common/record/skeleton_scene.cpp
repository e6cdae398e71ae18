// The names of fields are those of the published schemas (docs.foxglove.dev, message schemas).
#include "common/record/skeleton_scene.h"

#include <array>
#include <cmath>

#include "common/body/bones.h"
#include "common/resource/fixed_point.h"

namespace chorus::record {
namespace {

constexpr int kPointDecimals = 4;     // 0.1 mm, as in /frame
constexpr int kRotationDecimals = 6;  // for quaternions
constexpr std::int64_t kNsPerSecond = 1'000'000'000;

constexpr std::string_view kSceneSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "foxglove.SceneUpdate",
  "description": "Bodies as lines between joints",
  "type": "object",
  "properties": {
    "deletions": {"type": "array", "items": {"type": "object"}},
    "entities": {"type": "array", "items": {
      "type": "object",
      "properties": {
        "timestamp": {"type": "object", "title": "time", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}},
        "frame_id": {"type": "string"},
        "id": {"type": "string"},
        "lifetime": {"type": "object", "title": "duration", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}},
        "frame_locked": {"type": "boolean"},
        "metadata": {"type": "array", "items": {"type": "object"}},
        "arrows": {"type": "array", "items": {"type": "object"}},
        "cubes": {"type": "array", "items": {"type": "object"}},
        "spheres": {"type": "array", "items": {"type": "object"}},
        "cylinders": {"type": "array", "items": {"type": "object"}},
        "lines": {"type": "array", "items": {
          "type": "object",
          "properties": {
            "type": {"type": "integer", "description": "2: pairs of points"},
            "pose": {"type": "object", "properties": {
              "position": {"type": "object", "properties": {"x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}}},
              "orientation": {"type": "object", "properties": {"x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}, "w": {"type": "number"}}}
            }},
            "thickness": {"type": "number"},
            "scale_invariant": {"type": "boolean"},
            "points": {"type": "array", "items": {"type": "object", "properties": {"x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}}}},
            "color": {"type": "object", "properties": {"r": {"type": "number"}, "g": {"type": "number"}, "b": {"type": "number"}, "a": {"type": "number"}}},
            "colors": {"type": "array", "items": {"type": "object"}},
            "indices": {"type": "array", "items": {"type": "integer"}}
          }
        }},
        "triangles": {"type": "array", "items": {"type": "object"}},
        "texts": {"type": "array", "items": {"type": "object"}},
        "models": {"type": "array", "items": {"type": "object"}}
      }
    }}
  }
})";

constexpr std::string_view kTransformsSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "foxglove.FrameTransforms",
  "description": "Where the sensors stand",
  "type": "object",
  "properties": {
    "transforms": {"type": "array", "items": {
      "type": "object",
      "properties": {
        "timestamp": {"type": "object", "title": "time", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}},
        "parent_frame_id": {"type": "string"},
        "child_frame_id": {"type": "string"},
        "translation": {"type": "object", "properties": {"x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}}},
        "rotation": {"type": "object", "properties": {"x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}, "w": {"type": "number"}}}
      }
    }}
  }
})";

/// A body's colour is its id modulo the number of colours.
constexpr std::array<std::string_view, 6> kColours{
    R"({"r":0.2,"g":0.6,"b":1.0,"a":1.0})", R"({"r":1.0,"g":0.5,"b":0.1,"a":1.0})",
    R"({"r":0.3,"g":0.8,"b":0.3,"a":1.0})", R"({"r":0.9,"g":0.2,"b":0.3,"a":1.0})",
    R"({"r":0.6,"g":0.4,"b":0.9,"a":1.0})", R"({"r":0.1,"g":0.8,"b":0.8,"a":1.0})"};

constexpr std::string_view kLineStart =
    R"("lines":[{"type":2,"pose":{"position":{"x":0,"y":0,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1}},)"
    R"("thickness":0.03,"scale_invariant":false,"points":[)";

void put_number(std::string& out, double value, int decimals) {
  std::array<char, resource::kMaxFixedLength + 1> digits{};
  const bool writable = std::isfinite(value) && std::abs(value) <= resource::kMaxFixed;
  char* end = resource::write_fixed(digits.data(), writable ? value : 0.0, decimals);
  out.append(digits.data(), end);
}

void put_vector(std::string& out, const Eigen::Vector3d& v) {
  out += "{\"x\":";
  put_number(out, v.x(), kPointDecimals);
  out += ",\"y\":";
  put_number(out, v.y(), kPointDecimals);
  out += ",\"z\":";
  put_number(out, v.z(), kPointDecimals);
  out += "}";
}

void put_rotation(std::string& out, const Eigen::Quaterniond& q) {
  std::string_view key = "{\"x\":";
  constexpr std::array<std::string_view, 4> kNext{",\"y\":", ",\"z\":", ",\"w\":", "}"};
  const std::array<double, 4> parts{q.x(), q.y(), q.z(), q.w()};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out += key;
    put_number(out, parts[i], kRotationDecimals);
    key = kNext[i];
  }
  out += key;
}

std::string time_of(Timestamp t) {
  const std::int64_t ns = to_unix_ns(t);
  return "{\"sec\":" + std::to_string(ns / kNsPerSecond) +
         ",\"nsec\":" + std::to_string(ns % kNsPerSecond) + "}";
}

bool drawable(const resource::JointResource& joint) {
  return joint.seen() && joint.position.allFinite() &&
         joint.position.cwiseAbs().maxCoeff() <= kMaxCoordinate;
}

/// Writes the points of all drawable joints, and for each bone the indices of its two points if
/// both are drawable.
void put_lines(std::string& out, const resource::BodyResource& body) {
  std::array<int, kJointCount> number_of{};
  std::string points;
  int count = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    number_of[j] = drawable(body.joints[j]) ? count++ : -1;
    if (number_of[j] < 0) continue;
    if (number_of[j] > 0) points += ",";
    put_vector(points, body.joints[j].position);
  }
  std::string indices;
  for (const Bone& bone : kBones) {
    const int from = number_of[index_of(bone.parent)];
    const int to = number_of[index_of(bone.child)];
    if (from < 0 || to < 0) continue;
    indices += (indices.empty() ? "" : ",") + std::to_string(from) + "," + std::to_string(to);
  }
  if (indices.empty()) {  // In the schema, no indices would mean all points in order.
    out += "\"lines\":[]";
    return;
  }
  out.append(kLineStart).append(points).append("],\"color\":");
  out.append(kColours[body.id % kColours.size()]);
  out.append(",\"colors\":[],\"indices\":[").append(indices).append("]}]");
}

void put_entity(std::string& out, const resource::BodyResource& body, std::string_view start) {
  out.append(start).append("\"id\":\"body-").append(std::to_string(body.id));
  out += R"(","lifetime":{"sec":0,"nsec":500000000},"frame_locked":true,"metadata":[],)"
         R"("arrows":[],"cubes":[],"spheres":[],"cylinders":[],)";
  put_lines(out, body);
  out += R"(,"triangles":[],"texts":[],"models":[]})";
}

void put_transform(std::string& out, const std::string& start, const NamedPlace& place) {
  out.append(start).append(place.name).append("\",\"translation\":");
  put_vector(out, place.world_from_named.translation());
  out += ",\"rotation\":";
  put_rotation(out, Eigen::Quaterniond(place.world_from_named.linear()));
  out += "}";
}

}  // namespace

std::string_view scene_schema() { return kSceneSchema; }
std::string_view transforms_schema() { return kTransformsSchema; }

std::string scene_update(const resource::FrameResource& frame, std::string_view frame_id) {
  constexpr std::size_t kBodyBytes = 2048;
  std::string out;
  out.reserve((frame.bodies.size() + 1) * kBodyBytes);
  out += "{\"deletions\":[],\"entities\":[";
  const std::string start = "{\"timestamp\":" + time_of(frame.captured) + ",\"frame_id\":\"" +
                            std::string(frame_id) + "\",";
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
    if (i > 0) out += ",";
    put_entity(out, frame.bodies[i], start);
  }
  return out + "]}";
}

std::string frame_transforms(Timestamp at, const std::vector<NamedPlace>& places) {
  const auto start = [time = time_of(at)](std::string_view parent) {
    return "{\"timestamp\":" + time + ",\"parent_frame_id\":\"" + std::string(parent) +
           "\",\"child_frame_id\":\"";
  };
  const NamedPlace upright{std::string(kWorldFrame),
                           Eigen::Isometry3d(Eigen::AngleAxisd(std::acos(0.0),  // 90 degrees
                                                               Eigen::Vector3d::UnitX()))};
  std::string out = "{\"transforms\":[";
  put_transform(out, start("map"), upright);
  const std::string in_world = start(kWorldFrame);
  for (const NamedPlace& place : places) {
    out += ",";
    put_transform(out, in_world, place);
  }
  return out + "]}";
}

}  // namespace chorus::record
