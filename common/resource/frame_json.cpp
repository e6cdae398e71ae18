// Writes the frame in JSON and JSON-LD as fixed text with values put between.  `linked` means
// JSON-LD: with @context, with decimals as strings, and with IRIs of bodies and joints that contain
// their frame's.
#include <algorithm>

#include "common/body/bones.h"
#include "common/resource/fixed_point.h"
#include "common/resource/frame_parts.h"
#include "common/resource/frame_shares.h"
#include "common/resource/joint_texts.h"
#include "common/resource/pen.h"
#include "common/sensor/limits.h"

namespace chorus::resource {
namespace {

class JsonFrame {
 public:
  JsonFrame(const FrameResource& frame, bool linked, const Place& place)
      : frame_(frame),
        linked_(linked),
        names_(place.up() + place.names),
        frame_name_(names_ + (linked ? "frames/" + std::to_string(frame.sequence) : "frame")),
        context_(linked ? "\"@context\":\"" + place.up() + "context.jsonld\"," : ""),
        sensors_(quoted_names(frame)),
        share_list_(frame.sensors),
        pen_(1024 + frame.bodies.size() * kBodyBytes) {
    for (const std::string& name : sensors_) sensor_bytes_ += name.size() + kShareBytes;
  }

  std::string whole() {
    pen_.need(2 * kJointBytes + names_.size() + context_.size() + sensor_bytes_ +
              frame_.source.size() * 6);
    pen_.put("{");
    pen_.put(context_);
    pen_.put("\"@id\":\"");
    pen_.put(frame_name_);
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
    pen_.put(frame_name_);
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
    body_name_ = body_name(body);
    pen_.put(body_name_);
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
      pen_.put(",\"sidesConfidence\":");
      put_value<kConfidenceDecimals>(writable_confidence(*body.sides_confidence));
    }
    if (body.carried_for) {
      pen_.put(",\"carriedFor\":");
      put_value<kTimeDecimals>(writable_time(*body.carried_for));
    }
    if (body.smoothed_over) {
      pen_.put(",\"smoothedOver\":");
      put_value<kTimeDecimals>(writable_time(*body.smoothed_over));
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

  void put_living_name(const BodyResource& body) {
    pen_.put(names_);
    pen_.put("skeletons/");
    pen_.put_integer(body.id);
  }

  /// In JSON-LD the IRIs of bodies and joints contain their frame's, so that documents can be
  /// merged.
  [[nodiscard]] std::string body_name(const BodyResource& body) const {
    const std::string id = std::to_string(body.id);
    return linked_ ? frame_name_ + "#" + id : names_ + "skeletons/" + id;
  }

  void put_joints(const BodyResource& body) {
    const JointTexts& types = linked_ ? kLinkedTypes : kPlainTypes;
    std::string_view before = ",\"joints\":{";
    for (std::size_t i = 0; i < kJointCount; ++i) {
      pen_.need(kJointBytes + names_.size() + sensor_bytes_);
      pen_.put(before);
      pen_.put(kJsonOpenings[i]);
      pen_.put(body_name_);
      pen_.put(types[i]);
      put_joint(writable(body.joints[i]), body.joints[i]);
      pen_.put("}");
      before = ",";
    }
    pen_.put("}");
  }

  void put_joint(const WritableJoint& joint, const JointResource& origin) {
    if (joint.state != JointState::NotTracked) put_measured(joint);
    if (joint.has_orientation) {
      put_number<kQuaternionDecimals>("\"qx\":", joint.orientation.x());
      put_number<kQuaternionDecimals>("\"qy\":", joint.orientation.y());
      put_number<kQuaternionDecimals>("\"qz\":", joint.orientation.z());
      put_number<kQuaternionDecimals>("\"qw\":", joint.orientation.w());
    }
    if (joint.variance) put_number<kVarianceDecimals>("\"variance\":", *joint.variance);
    if (joint.covariance.known()) put_covariance(joint.covariance);
    pen_.put("\"state\":\"");
    pen_.put(name_of(joint.state));
    pen_.put("\"");
    if (joint.state != JointState::NotTracked) put_origin_of(origin);
  }

  /// Writes the joint's contributors and their shares, or for how long it has had no contributor.
  void put_origin_of(const JointResource& joint) {
    if (!sensors_.empty()) {
      pen_.put(",\"contributors\":");
      put_names(joint.contributors);
    }
    ShareList::Values values;
    std::string_view before = ",\"shares\":[";
    const auto list = share_list_.of(joint.shares, joint.contributors, values);
    for (const double share : list) {
      pen_.put(before);
      put_value<kShareDecimals>(share);
      before = ",";
    }
    if (!list.empty()) pen_.put("]");
    if (!joint.age) return;
    pen_.put(",\"age\":");
    put_value<kTimeDecimals>(writable_time(*joint.age));
  }

  void put_measured(const WritableJoint& joint) {
    if (joint.ray) {
      put_number<kRayDecimals>("\"rayX\":", joint.position.x());
      put_number<kRayDecimals>("\"rayY\":", joint.position.y());
      put_number<kRayDecimals>("\"rayZ\":", joint.position.z());
    } else {
      put_number<kPositionDecimals>("\"x\":", joint.position.x());
      put_number<kPositionDecimals>("\"y\":", joint.position.y());
      put_number<kPositionDecimals>("\"z\":", joint.position.z());
    }
  }

  void put_covariance(const Covariance& covariance) {
    put_number<kVarianceDecimals>("\"cxx\":", covariance.term(0));
    put_number<kVarianceDecimals>("\"cxy\":", covariance.term(1));
    put_number<kVarianceDecimals>("\"cxz\":", covariance.term(2));
    put_number<kVarianceDecimals>("\"cyy\":", covariance.term(3));
    put_number<kVarianceDecimals>("\"cyz\":", covariance.term(4));
    put_number<kVarianceDecimals>("\"czz\":", covariance.term(5));
  }

  template <int kDecimals, class Text>
  void put_number(const Text& key, double value) {
    pen_.put(key);
    put_value<kDecimals>(value);
    pen_.put(",");
  }

  template <int kDecimals>
  void put_value(double value) {
    if (linked_) pen_.put("\"");
    pen_.put_decimal<kDecimals>(value);
    if (linked_) pen_.put("\"");
  }

  const FrameResource& frame_;
  const bool linked_;
  const std::string names_;
  const std::string frame_name_;
  std::string body_name_;  ///< Of the body that is being written.
  const std::string context_;
  const std::vector<std::string> sensors_;
  const ShareList share_list_;
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
