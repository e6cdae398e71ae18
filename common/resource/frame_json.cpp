// Writes the frame in JSON and JSON-LD.  JSON-LD has @context, decimals as strings, and IRIs of
// bodies and joints that contain their frame's, so that documents can be merged.
// frame_json_template.cpp follows the layout of JSON byte for byte.
#include "common/body/bones.h"
#include "common/resource/frame_pen.h"

namespace chorus::resource {
namespace {

template <Style kStyle>
class JsonFrame {
 public:
  JsonFrame(const FrameResource& frame, const Place& place, std::size_t bodies)
      : frame_(frame),
        names_(place.up() + place.names),
        frame_name_(names_ + (kLinked ? "frames/" + std::to_string(frame.sequence) : "frame")),
        context_(kLinked ? "\"@context\":\"" + place.up() + "context.jsonld\"," : ""),
        pen_(frame, bodies) {}

  std::string whole() {
    pen_.need_more(names_.size() + context_.size());
    pen_.puts("{", context_, "\"@id\":\"", frame_name_, "\",\"@type\":\"Frame\"");
    pen_.put_sequence();
    pen_.put_times(frame_.captured);
    pen_.put_origin();
    pen_.put_sensors();
    pen_.put(",\"bodies\":[");
    std::string_view comma;
    for (const BodyResource& body : frame_.bodies) {
      pen_.need_more(names_.size());
      pen_.puts(comma, "{");
      put_body_head(body, false);
      put_joints(body);
      pen_.put("}");
      comma = ",";
    }
    pen_.put("]");
    put_props();
    pen_.need_more(0);
    pen_.put("}\n");
    return pen_.take();
  }

  std::string one(const BodyResource& body) {
    pen_.need_more(2 * names_.size() + context_.size());
    pen_.puts("{", context_);
    put_body_head(body, true);
    pen_.need_more(2 * names_.size());
    pen_.put_sequence();
    pen_.put_origin();
    pen_.puts(",\"frame\":\"", frame_name_, "\"");
    put_joints(body);
    pen_.put("}\n");
    return pen_.take();
  }

 private:
  static constexpr bool kLinked = kStyle == Style::JsonLd;

  /// `living`: the document describes the body itself, not its state at one instant, and states its
  /// type.
  void put_body_head(const BodyResource& body, bool living) {
    const std::string id = std::to_string(body.id);
    body_name_ = kLinked ? frame_name_ + "#" + id : names_ + "skeletons/" + id;
    pen_.puts("\"@id\":\"", body_name_, "\",\"@type\":\"Skeleton\"");
    if (kLinked) {
      pen_.puts(living ? ",\"of\":{\"@id\":\"" : ",\"of\":\"", names_, "skeletons/", id,
                living ? "\",\"@type\":\"TrackedBody\"}" : "\"");
    }
    pen_.put(",\"bodyId\":");
    pen_.put_unsigned(body.id);
    pen_.put_fields(BodyFields{}, body);
    pen_.put_times(body.captured);
  }

  void put_props() {
    std::string_view before = ",\"heldProps\":[";
    for (const PropResource& prop : frame_.props) {
      if (!writable(prop)) continue;
      pen_.need_more(names_.size());
      pen_.puts(before, "{\"@id\":\"", frame_name_, kPropMark, prop.name,
                "\",\"@type\":\"HeldProp\"");
      pen_.put_prop(prop);
      pen_.put("}");
      before = ",";
    }
    if (before == ",") pen_.put("]");
  }

  void put_joints(const BodyResource& body) {
    const JointTexts& types = kLinked ? kLinkedTypes : kPlainTypes;
    std::string_view before = ",\"joints\":{";
    for (std::size_t i = 0; i < kJointCount; ++i) {
      pen_.need_more(names_.size());
      pen_.puts(before, kJsonOpenings[i], body_name_, types[i]);
      pen_.put_joint(body.joints[i]);
      pen_.put("}");
      before = ",";
    }
    pen_.need_more(0);
    pen_.put("}");
  }

  const FrameResource& frame_;
  const std::string names_;
  const std::string frame_name_;
  std::string body_name_;  ///< Of the body that is being written.
  const std::string context_;
  FramePen<kStyle> pen_;
};

}  // namespace

std::string write_json(const FrameResource& frame, bool linked, const Place& place) {
  if (linked) return JsonFrame<Style::JsonLd>(frame, place, frame.bodies.size()).whole();
  return JsonFrame<Style::Json>(frame, place, frame.bodies.size()).whole();
}

std::string write_json_skeleton(const FrameResource& frame, const BodyResource& body, bool linked,
                                const Place& place) {
  if (linked) return JsonFrame<Style::JsonLd>(frame, place, 1).one(body);
  return JsonFrame<Style::Json>(frame, place, 1).one(body);
}

}  // namespace chorus::resource
