// Writes the compact profile in Turtle.  frame_fast_reader.cpp follows this layout byte for byte.
#include "common/body/bones.h"
#include "common/resource/frame_pen.h"

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
        pen_(frame, bodies) {}

  std::string whole() {
    pen_.need_more(names_.size());
    pen_.puts(kPrefixes, "\n<", frame_name_, "> a ch:Frame");
    pen_.put_sequence();
    pen_.put_times(frame_.captured);
    pen_.put_origin();
    pen_.put_sensors();
    put_prop_links();
    put_body_links();
    for (const BodyResource& body : frame_.bodies) {
      put_body(body);
      put_joint_links();
      put_joints(body);
    }
    for (const PropResource& prop : frame_.props) put_prop(prop);
    return pen_.take();
  }

  /// Begins with the body itself, as opposed to its state at one instant.  States no position of
  /// it, because statements from different instants would contradict each other.
  std::string one(const BodyResource& body) {
    pen_.need_more(names_.size());
    pen_.puts(kPrefixes, "\n<");
    put_living_name(body);
    pen_.put("> a ch:TrackedBody .\n");
    put_body(body);
    pen_.need_more(2 * names_.size());
    pen_.put_sequence();
    pen_.put_origin();
    pen_.puts(" ;\n  ch:frame <", frame_name_, ">");
    put_joint_links();
    put_joints(body);
    return pen_.take();
  }

 private:
  void put_body(const BodyResource& body) {
    pen_.need_more(2 * names_.size());
    body_name_ = body_name(body);
    pen_.puts("\n<", body_name_, "> a ch:Skeleton ;\n  ch:of <");
    put_living_name(body);
    pen_.put("> ;\n  ch:bodyId ");
    pen_.put_integer(body.id);
    pen_.put_fields(BodyFields{}, body);
    pen_.put_times(body.captured);
  }

  void put_living_name(const BodyResource& body) {
    pen_.puts(names_, "skeletons/");
    pen_.put_integer(body.id);
  }

  /// The IRI of a body at this instant; its `ch:of` points to the body itself.
  [[nodiscard]] std::string body_name(const BodyResource& body) const {
    return frame_name_ + "#" + std::to_string(body.id);
  }

  void put_prop_links() {
    std::string_view before = " ;\n  ch:heldProp <";
    for (const PropResource& prop : frame_.props) {
      if (!writable(prop)) continue;
      pen_.need_more(names_.size());
      pen_.puts(before, frame_name_, kPropMark, prop.name, ">");
      before = ", <";
    }
  }

  void put_prop(const PropResource& prop) {
    if (!writable(prop)) return;
    pen_.need_more(names_.size());
    pen_.puts("\n<", frame_name_, kPropMark, prop.name, "> a ch:HeldProp");
    pen_.put_prop(prop);
    pen_.put(" .\n");
  }

  void put_body_links() {
    std::string_view before = " ;\n  ch:body <";
    for (const BodyResource& body : frame_.bodies) {
      pen_.need_more(names_.size());
      pen_.puts(before, body_name(body), ">");
      before = ", <";
    }
    pen_.put(" .\n");
  }

  /// Of the body that was begun last.
  void put_joint_links() {
    pen_.need(kJointCount * (96 + body_name_.size()));
    std::string_view before = " ;\n  ch:joint <";
    for (const JointText& link : kTurtleLinks) {
      pen_.puts(before, body_name_, link);
      before = ", <";
    }
    pen_.put(" .\n");
  }

  void put_joints(const BodyResource& body) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
      pen_.need_more(names_.size());
      pen_.puts("\n<", body_name_, kTurtleHeads[i]);
      pen_.put_joint(body.joints[i]);
      pen_.put(" .\n");
    }
  }

  const FrameResource& frame_;
  const std::string names_;
  const std::string frame_name_;
  std::string body_name_;  ///< Of the body that was begun last.
  FramePen<Style::Turtle> pen_;
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
