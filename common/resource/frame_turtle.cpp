// Writes the compact profile in Turtle, from a template.  frame_fast_reader.cpp follows this layout
// byte for byte.
#include <algorithm>

#include "common/body/bones.h"
#include "common/resource/frame_parts.h"
#include "common/resource/frame_shares.h"
#include "common/resource/joint_texts.h"
#include "common/resource/pen.h"
#include "common/resource/terms.h"
#include "common/sensor/limits.h"

namespace chorus::resource {
namespace {

constexpr std::string_view kPrefixes =
    "@prefix ch: <https://w3id.org/chorus-tracking/ns#> .\n"
    "@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n";

class TurtleFrame {
 public:
  TurtleFrame(const FrameResource& frame, const Place& place, std::size_t bodies)
      : frame_(frame),
        names_(place.up() + place.names),
        frame_name_(names_ + "frames/" + std::to_string(frame.sequence)),
        sensors_(quoted_names(frame)),
        share_list_(frame.sensors),
        pen_(1024 + bodies * kBodyBytes) {
    for (const std::string& name : sensors_) sensor_bytes_ += name.size() + kShareBytes;
  }

  std::string whole() {
    begin_frame();
    put_sequence();
    put_times(frame_.captured);
    put_origin();
    if (!sensors_.empty()) {
      pen_.put(" ;\n  ch:sensor ");
      put_names(~std::uint64_t{0});
    }
    put_body_links();
    pen_.put(" .\n");
    for (const BodyResource& body : frame_.bodies) {
      begin_body(body);
      put_joint_links();
      put_joints(body);
    }
    return pen_.take();
  }

  std::string one(const BodyResource& body) {
    begin_living(body);
    begin_body(body);
    put_sequence();
    put_origin();
    pen_.put(" ;\n  ch:frame <");
    pen_.put(frame_name_);
    pen_.put(">");
    put_joint_links();
    put_joints(body);
    return pen_.take();
  }

 private:
  void begin_frame() {
    pen_.need(kJointBytes + names_.size() + sensor_bytes_ + frame_.source.size() * 6);
    pen_.put(kPrefixes);
    pen_.put("\n<");
    pen_.put(frame_name_);
    pen_.put("> a ch:Frame");
    begun_ = true;
  }

  /// Begins a document with the body itself, as opposed to its state at one instant.  States no
  /// position of it, because statements from different instants would contradict each other.
  void begin_living(const BodyResource& body) {
    pen_.need(kJointBytes + names_.size());
    pen_.put(kPrefixes);
    pen_.put("\n<");
    put_living_name(body);
    pen_.put("> a ch:TrackedBody .\n");
    begun_ = true;
  }

  void begin_body(const BodyResource& body) {
    pen_.need(2 * kJointBytes + 2 * names_.size() + frame_.source.size() * 6);
    if (!begun_) pen_.put(kPrefixes);
    begun_ = true;
    pen_.put("\n<");
    body_name_ = body_name(body);
    pen_.put(body_name_);
    pen_.put("> a ch:Skeleton ;\n  ch:of <");
    put_living_name(body);
    pen_.put("> ;\n  ch:bodyId ");
    pen_.put_integer(body.id);
    if (body.slot) {
      pen_.put(" ;\n  ch:slot ");
      pen_.put_integer(*body.slot);
    }
    if (body.sides_confidence) {
      pen_.put(" ;\n  ch:sidesConfidence ");
      pen_.put_decimal<kConfidenceDecimals>(writable_confidence(*body.sides_confidence));
    }
    if (body.carried_for) {
      pen_.put(" ;\n  ch:carriedFor ");
      pen_.put_decimal<kTimeDecimals>(writable_time(*body.carried_for));
    }
    if (body.smoothed_over) {
      pen_.put(" ;\n  ch:smoothedOver ");
      pen_.put_decimal<kTimeDecimals>(writable_time(*body.smoothed_over));
    }
    put_times(body.captured);
  }

  void put_sequence() {
    pen_.put(" ;\n  ch:sequence ");
    pen_.put_integer(frame_.sequence);
  }

  void put_times(Timestamp captured) {
    pen_.put(" ;\n  ch:captured \"");
    pen_.put(time_.of(captured));
    pen_.put("\"^^xsd:dateTime ;\n  ch:capturedNanoseconds ");
    pen_.put_integer(to_unix_ns(captured));
  }

  void put_origin() {
    pen_.put(" ;\n  ch:source ");
    pen_.put(in_quotes(frame_.source));
    pen_.put(" ;\n  ch:space ch:");
    pen_.put(name_of(frame_.space));
  }

  void put_names(std::uint64_t bits) {
    std::string_view comma;
    for (std::size_t i = 0; i < std::min(sensors_.size(), kMaxSensors); ++i) {
      if ((bits >> i & 1U) == 0) continue;
      pen_.put(comma);
      pen_.put(sensors_[i]);
      comma = ", ";
    }
  }

  void put_living_name(const BodyResource& body) {
    pen_.put(names_);
    pen_.put("skeletons/");
    pen_.put_integer(body.id);
  }

  /// The IRI of a body at this instant; its `ch:of` points to the body itself.
  [[nodiscard]] std::string body_name(const BodyResource& body) const {
    return frame_name_ + "#" + std::to_string(body.id);
  }

  void put_body_links() {
    std::string_view before = " ;\n  ch:body <";
    for (const BodyResource& body : frame_.bodies) {
      pen_.need(kJointBytes + names_.size());
      pen_.put(before);
      pen_.put(body_name(body));
      pen_.put(">");
      before = ", <";
    }
  }

  /// Of the body that was begun last.
  void put_joint_links() {
    pen_.need(kJointCount * (96 + body_name_.size()));
    std::string_view before = " ;\n  ch:joint <";
    for (const JointText& link : kTurtleLinks) {
      pen_.put(before);
      pen_.put(body_name_);
      pen_.put(link);
      before = ", <";
    }
    pen_.put(" .\n");
  }

  void put_joints(const BodyResource& body) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
      pen_.need(kJointBytes + names_.size() + sensor_bytes_);
      pen_.put("\n<");
      pen_.put(body_name_);
      pen_.put(kTurtleHeads[i]);
      put_joint(writable(body.joints[i]), body.joints[i]);
      pen_.put(" .\n");
    }
  }

  void put_joint(const WritableJoint& joint, const JointResource& origin) {
    if (joint.state != JointState::NotTracked) put_measured(joint);
    if (joint.has_orientation) {
      put_number<kQuaternionDecimals>("  ch:qx ", joint.orientation.x());
      put_number<kQuaternionDecimals>(" ; ch:qy ", joint.orientation.y());
      put_number<kQuaternionDecimals>(" ; ch:qz ", joint.orientation.z());
      put_number<kQuaternionDecimals>(" ; ch:qw ", joint.orientation.w());
      pen_.put(" ;\n");
    }
    pen_.put("  ch:state ch:");
    pen_.put(name_of(joint.state));
    if (joint.variance) put_number<kVarianceDecimals>(" ;\n  ch:variance ", *joint.variance);
    if (joint.covariance.known()) put_covariance(joint.covariance);
    if (joint.state != JointState::NotTracked) put_origin_of(origin);
  }

  /// Writes the joint's contributors and their shares, or for how long it has had no contributor.
  void put_origin_of(const JointResource& joint) {
    const std::uint64_t known = sensors_.size() >= kMaxSensors
                                    ? ~std::uint64_t{0}
                                    : (std::uint64_t{1} << sensors_.size()) - 1;
    if ((joint.contributors & known) != 0) {
      pen_.put(" ;\n  ch:contributor ");
      put_names(joint.contributors);
    }
    ShareList::Values values;
    std::string_view before = " ;\n  ch:shares (";
    const auto list = share_list_.of(joint.shares, joint.contributors, values);
    for (const double share : list) {
      put_number<kShareDecimals>(before, share);
      before = " ";
    }
    if (!list.empty()) pen_.put(")");
    if (joint.age) put_number<kTimeDecimals>(" ;\n  ch:age ", writable_time(*joint.age));
  }

  void put_measured(const WritableJoint& joint) {
    if (joint.ray) {
      put_number<kRayDecimals>("  ch:rayX ", joint.position.x());
      put_number<kRayDecimals>(" ; ch:rayY ", joint.position.y());
      put_number<kRayDecimals>(" ; ch:rayZ ", joint.position.z());
    } else {
      put_number<kPositionDecimals>("  ch:x ", joint.position.x());
      put_number<kPositionDecimals>(" ; ch:y ", joint.position.y());
      put_number<kPositionDecimals>(" ; ch:z ", joint.position.z());
    }
    pen_.put(" ;\n");
  }

  void put_covariance(const Covariance& covariance) {
    put_number<kVarianceDecimals>(" ;\n  ch:cxx ", covariance.term(0));
    put_number<kVarianceDecimals>(" ; ch:cxy ", covariance.term(1));
    put_number<kVarianceDecimals>(" ; ch:cxz ", covariance.term(2));
    put_number<kVarianceDecimals>(" ; ch:cyy ", covariance.term(3));
    put_number<kVarianceDecimals>(" ; ch:cyz ", covariance.term(4));
    put_number<kVarianceDecimals>(" ; ch:czz ", covariance.term(5));
  }

  template <int kDecimals, class Text>
  void put_number(const Text& before, double value) {
    pen_.put(before);
    pen_.put_decimal<kDecimals>(value);
  }

  const FrameResource& frame_;
  const std::string names_;
  const std::string frame_name_;
  std::string body_name_;  ///< Of the body that was begun last.
  const std::vector<std::string> sensors_;
  const ShareList share_list_;
  std::size_t sensor_bytes_ = 0;
  bool begun_ = false;
  TimeText time_;
  Pen pen_;
};

}  // namespace

std::string write_turtle(const FrameResource& frame, const Place& place) {
  return TurtleFrame(frame, place, frame.bodies.size()).whole();
}

std::string write_turtle_skeleton(const FrameResource& frame, const BodyResource& body,
                                  const Place& place) {
  return TurtleFrame(frame, place, 1).one(body);
}

}  // namespace chorus::resource
