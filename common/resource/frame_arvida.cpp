// Profile "arvida": the full ARVIDA pattern, one spatial relationship per joint (proto/README.md).
//
// In a relationship, the source is the tracker's space, the target is the joint, and the
// translation is the joint's position in the source.  No document specifies this direction; we
// follow a published client.
#include <algorithm>

#include "common/body/bones.h"
#include "common/resource/frame_pen.h"

namespace chorus::resource {
namespace {

constexpr std::string_view kArvidaPrefixes =
    "@prefix ch: <https://w3id.org/chorus-tracking/ns#> .\n"
    "@prefix core: <http://vocab.arvida.de/2015/06/core/vocab#> .\n"
    "@prefix maths: <http://vocab.arvida.de/2015/06/maths/vocab#> .\n"
    "@prefix skel: <http://vocab.arvida.de/2015/05/skel/vocab#> .\n"
    "@prefix spatial: <http://vocab.arvida.de/2015/06/spatial/vocab#> .\n"
    "@prefix tracking: <http://vocab.arvida.de/2015/06/tracking/vocab#> .\n"
    "@prefix vom: <http://vocab.arvida.de/2015/06/vom/vocab#> .\n"
    "@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n";

constexpr std::string_view kDouble = "\"^^xsd:double";
constexpr std::size_t kJointText = 2048;  // Bytes of the longest joint, without its names.

/// What stands before a number of a vector: " ; maths:x \"".
template <class Field, std::size_t kI>
constexpr JointText kMaths = [] {
  JointText text;
  ((text += " ; maths:") += Field::kNames[kI].axis) += " \"";
  return text;
}();

class ArvidaFrame {
 public:
  ArvidaFrame(const FrameResource& frame, const Place& place)
      : frame_(frame), names_(place.up() + place.names), pen_(frame, 2 * frame.bodies.size()) {}

  std::string run() {
    put_frame();
    for (const BodyResource& body : frame_.bodies) {
      put_body(body);
      for (std::size_t i = 0; i < kJointCount; ++i) put_joint(body, i);
    }
    return pen_.take();
  }

 private:
  void put_frame() {
    pen_.need(kJointText + 2 * names_.size() + frame_.source.size() * 6);
    put(kArvidaPrefixes, "\n<", names_, "frame> a ch:Frame, core:Container");
    pen_.put_sequence();
    pen_.put_times(frame_.captured);
    pen_.put_origin();
    std::string_view before = " ;\n  core:member <";
    for (const BodyResource& body : frame_.bodies) {
      pen_.need(kJointText + names_.size());
      pen_.put(before);
      pen_.put(body_name(body));
      pen_.put(">");
      before = ", <";
    }
    pen_.need(kJointText + names_.size());
    put(" .\n\n<", names_, "frame#space> a maths:RightHandedCartesianCoordinateSystem3D ;\n",
        "  maths:axesUnit vom:meter .\n");
  }

  void put_body(const BodyResource& body) {
    pen_.need(kJointText + kJointCount * (64 + names_.size()));
    pen_.put("\n<");
    body_name_ = body_name(body);
    pen_.put(body_name_);
    pen_.put("> a skel:Skeleton ;\n  ch:bodyId ");
    pen_.put_integer(body.id);
    pen_.put_fields(BodyFields{}, body);
    pen_.need(kJointText + kJointCount * (64 + names_.size()));
    std::string_view before = " ;\n  skel:skeletonJoint <";
    for (const std::string_view joint : kJointNames) {
      pen_.put(before);
      put_joint_name(joint);
      pen_.put(">");
      before = ", <";
    }
    pen_.put(" .\n");
  }

  void put_joint(const BodyResource& body, std::size_t index) {
    const std::string_view name = kJointNames[index];
    const JointResource& joint = body.joints[index];
    const JointState state = writable_state(joint);
    pen_.need(kJointText + 5 * (names_.size() + 64));
    pen_.put("\n<");
    put_joint_name(name);
    put("> a skel:Joint, spatial:SpatialRelationship, core:Output, core:Pull ;\n",
        "  ch:jointName \"", name, "\" ;\n  ch:state ch:", name_of(state),
        " ;\n  spatial:sourceCoordinateSystem <", names_,
        "frame#space> ;\n  spatial:targetCoordinateSystem <");
    put_joint_name(name);
    pen_.put("-space> ;\n  spatial:spatialRelationship <");
    put_joint_name(name);
    pen_.put(">");
    put_timestamp(body.captured);
    if (state != JointState::NotTracked) put_place(joint);
    pen_.put(" .\n\n<");
    put_joint_name(name);
    pen_.put("-space> a maths:RightHandedCartesianCoordinateSystem3D .\n");
  }

  void put_timestamp(Timestamp captured) {
    pen_.put(
        " ;\n  spatial:timestamp [ a tracking:UnixTimestamp ; vom:quantityValue [ a "
        "vom:QuantityValue ; "
        "vom:numericalValue \"");
    pen_.put_integer(std::max<std::int64_t>(0, to_unix_ns(captured)));  // unsignedLong has no sign.
    pen_.put("\"^^xsd:unsignedLong ; vom:unit vom:NanoSecond ] ]");
  }

  void put_place(const JointResource& joint) {
    if (const auto p = Position::get(joint)) {
      pen_.put(
          " ;\n  spatial:translation [ a spatial:Translation3D ; vom:quantityKind vom:Length ; "
          "vom:quantityValue [ a maths:Vector3D");
      put_numbers<Position>(*p, std::make_index_sequence<3>{});
      pen_.put(" ; vom:unit vom:meter ] ]");
    }
    if (const auto q = Orientation::get(joint)) {
      pen_.put(
          " ;\n  spatial:rotation [ a spatial:Rotation3D ; vom:quantityKind vom:Angle ; "
          "vom:quantityValue [ a maths:Quaternion, maths:Vector4D");
      put_numbers<Orientation>(*q, std::make_index_sequence<4>{});
      pen_.put(" ] ]");
    }
  }

  template <class Field, std::size_t... kI>
  void put_numbers(const FieldValues<sizeof...(kI)>& values, std::index_sequence<kI...>) {
    (put_number<Field::kRow.decimals>(kMaths<Field, kI>, values[kI]), ...);
  }

  template <int kDecimals>
  void put_number(std::string_view before, double value) {
    pen_.put(before);
    pen_.template put_decimal<kDecimals>(value);
    pen_.put(kDouble);
  }

  [[nodiscard]] std::string body_name(const BodyResource& body) const {
    return names_ + "skeletons/" + std::to_string(body.id);
  }
  /// Of the body that was begun last.
  void put_joint_name(std::string_view joint) { put(body_name_, "#", joint); }

  template <class... Text>
  void put(const Text&... text) {
    pen_.puts(text...);
  }

  const FrameResource& frame_;
  const std::string names_;
  std::string body_name_;  ///< Of the body that was begun last.
  FramePen<Style::Turtle> pen_;
};

}  // namespace

std::string write_arvida(const FrameResource& frame, const Place& place, Format format) {
  std::string turtle = ArvidaFrame(frame, place).run();
  return format == Format::NTriples ? to_ntriples(turtle, place) : turtle;
}

}  // namespace chorus::resource
