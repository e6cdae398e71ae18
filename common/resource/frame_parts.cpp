#include "common/resource/frame_parts.h"

#include <algorithm>
#include <cmath>

#include "common/rdf/turtle_writer.h"
#include "common/rdf/utf8.h"

namespace chorus::resource {
namespace {

bool plausible(const JointResource& joint) {
  const Eigen::Vector3d& p = joint.position;
  if (!p.allFinite()) return false;
  if (joint.measurement == Measurement::Ray) return std::abs(p.norm() - 1.0) <= kRayTolerance;
  return p.cwiseAbs().maxCoeff() <= kMaxCoordinate;
}

}  // namespace

JointState writable_state(const JointResource& joint) {
  return plausible(joint) ? joint.state : JointState::NotTracked;
}

bool writable(const PropResource& prop) {
  constexpr std::size_t kLongest = 32;
  const double length = prop.orientation.norm();
  return is_name(prop.name) && prop.name.size() <= kLongest && prop.position.allFinite() &&
         prop.position.cwiseAbs().maxCoeff() <= kMaxCoordinate && std::abs(length - 1.0) < 0.1;
}

bool is_name(std::string_view text) { return SensorId::parse(text).has_value(); }

std::string in_quotes(std::string_view text) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string out = "\"";
  for (const char c : rdf::clean_utf8(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out.append(1, '\\').append(1, c);
    } else if (byte < 0x20) {
      out.append("\\u00").append(1, kHex[byte >> 4U]).append(1, kHex[byte & 15U]);
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::vector<std::string> quoted_names(const FrameResource& frame) {
  std::vector<std::string> names;
  names.reserve(frame.sensors.size());
  for (const std::string& name : frame.sensors) names.push_back(in_quotes(name));
  return names;
}

std::string_view name_of(JointState state) {
  switch (state) {
    case JointState::Tracked:
      return "Tracked";
    case JointState::Inferred:
      return "Inferred";
    case JointState::NotTracked:
      break;
  }
  return "NotTracked";
}

std::string_view name_of(SpaceKind space) {
  return space == SpaceKind::World ? "WorldSpace" : "SensorSpace";
}

std::string to_ntriples(const std::string& turtle, const Place& place) {
  // Our own Turtle has no errors, and its size need not be limited.
  return rdf::turtle_to_ntriples(turtle, place.root + place.path, turtle.size()).value_or("");
}

std::string write(const FrameResource& frame, Format format, const Place& place) {
  switch (format) {
    case Format::Turtle:
      return write_turtle(frame, place);
    case Format::JsonLd:
      return write_json(frame, true, place);
    case Format::Json:
      return write_json(frame, false, place);
    case Format::NTriples:
      return to_ntriples(write_turtle(frame, place), place);
  }
  return {};
}

std::string write_skeleton(const FrameResource& frame, const BodyResource& body, Format format,
                           const Place& place) {
  switch (format) {
    case Format::Turtle:
      return write_turtle_skeleton(frame, body, place);
    case Format::JsonLd:
      return write_json_skeleton(frame, body, true, place);
    case Format::Json:
      return write_json_skeleton(frame, body, false, place);
    case Format::NTriples:
      return to_ntriples(write_turtle_skeleton(frame, body, place), place);
  }
  return {};
}

FrameResource to_resource(const SensorFrame& frame) {
  FrameResource out;
  out.sequence = frame.sequence;
  out.captured = frame.captured;
  out.source = frame.sensor.str();
  out.bodies.reserve(frame.bodies.size());
  for (const BodyFrame& body : frame.bodies) {
    BodyResource& written = out.bodies.emplace_back();
    written.id = body.id.value;
    written.captured = body.captured;
    if (body.hands) {
      written.left_hand = body.hands->left;
      written.right_hand = body.hands->right;
    }
    for (std::size_t i = 0; i < kJointCount; ++i)
      written.joints[i] = {body.skeleton.joints[i], std::nullopt, 0};
  }
  return out;
}

SensorFrame to_sensor_frame(const FrameResource& frame, SensorId sensor, Timestamp received) {
  SensorFrame out;
  out.sensor = std::move(sensor);
  out.sequence = frame.sequence;
  out.captured = frame.captured;
  out.received = received;
  out.bodies.reserve(frame.bodies.size());
  for (const BodyResource& body : frame.bodies) {
    BodyFrame& seen = out.bodies.emplace_back();
    seen.id = BodyId{body.id};
    seen.captured = body.captured;
    seen.hands = shared({body.left_hand, body.right_hand});
    for (std::size_t i = 0; i < kJointCount; ++i) {
      Joint& read = seen.skeleton.joints[i];
      read = body.joints[i];
      if (read.bears()) read.position.normalize();
    }
  }
  return out;
}

}  // namespace chorus::resource
