// Writes the frame in JSON and JSON-LD as fixed text with values put between.  `linked` means
// JSON-LD: with @context, with decimals as strings, and with IRIs of bodies and joints that contain
// their frame's.
#include <algorithm>

#include "common/body/bones.h"
#include "common/resource/fixed_point.h"
#include "common/resource/frame_parts.h"
#include "common/sensor/limits.h"

namespace chorus::resource {
namespace {

class JsonFrame {
 public:
  JsonFrame(const FrameResource& frame, bool linked, const Place& place)
      : frame_(frame),
        linked_(linked),
        names_(place.up() + place.names),
        context_(linked ? "\"@context\":\"" + place.up() + "context.jsonld\"," : ""),
        sensors_(quoted_names(frame)),
        pen_(1024 + frame.bodies.size() * kBodyBytes) {
    for (const std::string& name : sensors_) sensor_bytes_ += name.size() + 2;
  }

  std::string whole() {
    pen_.need(2 * kJointBytes + names_.size() + context_.size() + sensor_bytes_ +
              frame_.source.size() * 6);
    pen_.put("{");
    pen_.put(context_);
    pen_.put("\"@id\":\"");
    put_frame_name();
    pen_.put("\",\"@type\":\"Frame\"");
    put_sequence();
    put_times(frame_.captured);
    put_origin();
    if (!sensors_.empty()) {
      pen_.put(",\"sensors\":");
      put_names(~std::uint64_t{0});
    }
    pen_.put(",\"bodies\":[");
    std::string_view comma;
    for (const BodyResource& body : frame_.bodies) {
      pen_.need(kJointBytes + names_.size());
      pen_.put(comma);
      pen_.put("{");
      put_body_head(body, false);
      put_joints(body);
      pen_.put("}");
      comma = ",";
    }
    pen_.need(kJointBytes);
    pen_.put("]}\n");
    return pen_.take();
  }

  std::string one(const BodyResource& body) {
    pen_.need(2 * kJointBytes + 2 * names_.size() + context_.size() + frame_.source.size() * 6);
    pen_.put("{");
    pen_.put(context_);
    put_body_head(body, true);
    put_sequence();
    put_origin();
    pen_.put(",\"frame\":\"");
    put_frame_name();
    pen_.put("\"");
    put_joints(body);
    pen_.need(kJointBytes);
    pen_.put("}\n");
    return pen_.take();
  }

 private:
  /// `living`: the document describes the body itself, not its state at one instant, and states its
  /// type.
  void put_body_head(const BodyResource& body, bool living) {
    pen_.put("\"@id\":\"");
    put_body_name(body);
    pen_.put("\",\"@type\":\"Skeleton\"");
    if (linked_) {
      pen_.put(living ? ",\"of\":{\"@id\":\"" : ",\"of\":\"");
      put_living_name(body);
      pen_.put(living ? "\",\"@type\":\"TrackedBody\"}" : "\"");
    }
    pen_.put(",\"bodyId\":");
    put_unsigned(body.id);
    if (body.slot) {
      pen_.put(",\"slot\":");
      pen_.put_integer(*body.slot);
    }
    if (body.sides_confidence) {
      pen_.put(linked_ ? ",\"sidesConfidence\":\"" : ",\"sidesConfidence\":");
      pen_.put_decimal(writable_confidence(*body.sides_confidence), kConfidenceDecimals);
      pen_.put(linked_ ? "\"" : "");
    }
    if (body.carried_for) {
      pen_.put(linked_ ? ",\"carriedFor\":\"" : ",\"carriedFor\":");
      pen_.put_decimal(writable_time(*body.carried_for), kTimeDecimals);
      pen_.put(linked_ ? "\"" : "");
    }
    put_times(body.captured);
  }

  void put_sequence() {
    pen_.put(",\"sequence\":");
    put_unsigned(frame_.sequence);
  }

  void put_unsigned(std::uint64_t value) {
    const std::string_view mark = value < std::uint64_t{kExactInteger} ? "" : "\"";
    pen_.put(mark);
    pen_.put_integer(value);
    pen_.put(mark);
  }

  void put_times(Timestamp captured) {
    pen_.put(",\"captured\":\"");
    pen_.put(time_.of(captured));
    pen_.put("\",\"capturedNanoseconds\":\"");
    pen_.put_integer(to_unix_ns(captured));
    pen_.put("\"");
  }

  void put_origin() {
    pen_.put(",\"source\":");
    pen_.put(in_quotes(frame_.source));
    pen_.put(",\"space\":\"");
    pen_.put(name_of(frame_.space));
    pen_.put("\"");
  }

  void put_names(std::uint64_t bits) {
    pen_.put("[");
    std::string_view comma;
    for (std::size_t i = 0; i < std::min(sensors_.size(), kMaxSensors); ++i) {
      if ((bits >> i & 1U) == 0) continue;
      pen_.put(comma);
      pen_.put(sensors_[i]);
      comma = ",";
    }
    pen_.put("]");
  }

  /// In JSON-LD the IRIs of bodies and joints contain their frame's, so that documents can be
  /// merged.
  void put_frame_name() {
    pen_.put(names_);
    if (!linked_) return pen_.put("frame");
    pen_.put("frames/");
    pen_.put_integer(frame_.sequence);
  }

  void put_living_name(const BodyResource& body) {
    pen_.put(names_);
    pen_.put("skeletons/");
    pen_.put_integer(body.id);
  }

  void put_body_name(const BodyResource& body) {
    if (!linked_) return put_living_name(body);
    put_frame_name();
    pen_.put("#");
    pen_.put_integer(body.id);
  }

  void put_joints(const BodyResource& body) {
    std::string_view before = ",\"joints\":{\"";
    for (std::size_t i = 0; i < kJointCount; ++i) {
      pen_.need(kJointBytes + names_.size() + sensor_bytes_);
      pen_.put(before);
      pen_.put(kJointNames[i]);
      pen_.put("\":{\"@id\":\"");
      put_body_name(body);
      pen_.put(linked_ ? "-" : "#");
      pen_.put(kJointNames[i]);
      pen_.put("\",\"@type\":\"Joint\",");
      put_joint(writable(body.joints[i]), body.joints[i].contributors);
      pen_.put("}");
      before = ",\"";
    }
    pen_.put("}");
  }

  void put_joint(const WritableJoint& joint, std::uint64_t contributors) {
    if (joint.state != JointState::NotTracked) put_measured(joint);
    if (joint.has_orientation) {
      put_number("\"qx\":", joint.orientation.x(), kQuaternionDecimals);
      put_number("\"qy\":", joint.orientation.y(), kQuaternionDecimals);
      put_number("\"qz\":", joint.orientation.z(), kQuaternionDecimals);
      put_number("\"qw\":", joint.orientation.w(), kQuaternionDecimals);
    }
    if (joint.variance) put_number("\"variance\":", *joint.variance, kVarianceDecimals);
    if (joint.covariance.known()) put_covariance(joint.covariance);
    pen_.put("\"state\":\"");
    pen_.put(name_of(joint.state));
    pen_.put("\"");
    if (joint.state != JointState::NotTracked && !sensors_.empty()) {
      pen_.put(",\"contributors\":");
      put_names(contributors);
    }
  }

  void put_measured(const WritableJoint& joint) {
    const int decimals = joint.ray ? kRayDecimals : kPositionDecimals;
    put_number(joint.ray ? "\"rayX\":" : "\"x\":", joint.position.x(), decimals);
    put_number(joint.ray ? "\"rayY\":" : "\"y\":", joint.position.y(), decimals);
    put_number(joint.ray ? "\"rayZ\":" : "\"z\":", joint.position.z(), decimals);
  }

  void put_covariance(const Covariance& covariance) {
    for (std::size_t i = 0; i < kCovarianceNames.size(); ++i) {
      pen_.put("\"");
      pen_.put(kCovarianceNames[i]);
      put_number("\":", covariance.term(i), kVarianceDecimals);
    }
  }

  void put_number(std::string_view key, double value, int decimals) {
    pen_.put(key);
    pen_.put(linked_ ? "\"" : "");
    pen_.put_decimal(value, decimals);
    pen_.put(linked_ ? "\"," : ",");
  }

  const FrameResource& frame_;
  const bool linked_;
  const std::string names_;
  const std::string context_;
  const std::vector<std::string> sensors_;
  std::size_t sensor_bytes_ = 0;
  TimeText time_;
  Pen pen_;
};

}  // namespace

std::string write_json(const FrameResource& frame, bool linked, const Place& place) {
  return JsonFrame(frame, linked, place).whole();
}

std::string write_json_skeleton(const FrameResource& frame, const BodyResource& body, bool linked,
                                const Place& place) {
  return JsonFrame(frame, linked, place).one(body);
}

}  // namespace chorus::resource
