// Reads the JSON that frame_json.cpp writes by following its template, as frame_fast_reader.cpp
// does for Turtle: at anything unexpected the result is nullopt, and the parser reads the document.
#include <algorithm>
#include <array>
#include <cmath>

#include "common/body/bones.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_parts.h"
#include "common/resource/joint_texts.h"
#include "common/resource/template_text.h"

namespace chorus::resource {
namespace {

class JsonTemplate : TemplateText {
 public:
  using TemplateText::TemplateText;

  std::optional<FrameResource> run() {
    if (!head() || !bodies() || !text("}")) return std::nullopt;
    text("\n");
    if (!at_end()) return std::nullopt;
    return std::move(frame_);
  }

 private:
  bool captured(Timestamp& out) {
    return text(",\"captured\":\"") && times("\",\"capturedNanoseconds\":\"", out) && text("\"");
  }

  bool head() {
    if (!text("{\"@id\":\"") || !folder("frame\",\"@type\":\"Frame\",\"sequence\":", names_))
      return false;
    std::string_view source;
    if (!integer(frame_.sequence) || !captured(frame_.captured)) return false;
    if (!text(",\"source\":") || !name(source) || !text(",\"space\":\"")) return false;
    frame_.source = source;
    if (text("WorldSpace")) {
      frame_.space = SpaceKind::World;
    } else if (!text("SensorSpace")) {
      return false;
    }
    if (!text("\"")) return false;
    if (text(",\"sensors\":[") && !(names(",", frame_.sensors) && text("]"))) return false;
    share_list_.emplace(frame_.sensors);
    return true;
  }

  bool bodies() {
    if (!text(",\"bodies\":[")) return false;
    if (text("]")) return true;
    do {
      const std::size_t before = rest().size();
      if (frame_.bodies.size() == kMaxBodies || !body(frame_.bodies.emplace_back())) return false;
      // Bodies are large, and moving them costs; most take as many bytes as the first.
      if (frame_.bodies.size() == 1)
        frame_.bodies.reserve(std::min(kMaxBodies, 2 + rest().size() / (before - rest().size())));
    } while (text(","));
    return text("]");
  }

  bool body(BodyResource& body) {
    const char* const begin = here() + std::string_view("{\"@id\":\"").size();
    std::uint64_t id = 0;
    if (!text("{\"@id\":\"") || !text(names_) || !text("skeletons/") || !integer(body.id))
      return false;
    const std::string_view iri(begin, static_cast<std::size_t>(here() - begin));
    if (!text("\",\"@type\":\"Skeleton\",\"bodyId\":") || !id_number(id) || id != body.id)
      return false;
    if (text(",\"slot\":") && !slot(frame_.bodies, body.slot)) return false;
    if (text(",\"sidesConfidence\":") && !confidence(body.sides_confidence)) return false;
    if (text(",\"carriedFor\":") && !duration(body.carried_for)) return false;
    if (text(",\"smoothedOver\":") && !duration(body.smoothed_over)) return false;
    const auto twin = std::ranges::find(frame_.bodies, id, &BodyResource::id);
    if (&*twin != &body || !captured(body.captured)) return false;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!text(i == 0 ? ",\"joints\":{" : ",") || !text(kJsonOpenings[i]) || !text(iri))
        return false;
      if (!text(kPlainTypes[i]) && !untyped(i)) return false;
      if (!text("\"") || !joint(body.joints[i])) return false;
    }
    return text("}}");
  }

  /// Recordings of earlier versions lack the type.
  bool untyped(std::size_t i) { return text("#") && text(kJointNames[i]) && text("\","); }

  /// Reads an id; ids that a double cannot represent exactly are in quotes.
  bool id_number(std::uint64_t& id) {
    const bool quoted = text("\"");
    return integer(id) && (!quoted || text("\""));
  }

  /// Starts after the first property's opening quote; stops after the closing brace.
  bool joint(JointResource& joint) {
    if (text("state\":\"NotTracked\"}")) return true;
    if (!(text("ray") ? ray(joint) : point(joint)) || !text(",\"")) return false;
    if (text("qx\":") && !orientation(joint.orientation)) return false;
    if (text("variance\":")) {
      double variance = 0.0;
      if (!decimal<kVarianceDecimals>(variance) || variance < 0.0 || !text(",\"")) return false;
      joint.variance = variance;
    }
    if (text("cxx\":") && !covariance(joint.covariance)) return false;
    if (!text("state\":\"")) return false;
    joint.state = text("Tracked") ? JointState::Tracked : JointState::Inferred;
    if (joint.state == JointState::Inferred && !text("Inferred")) return false;
    if (!text("\"")) return false;
    return origin(joint) && text("}");
  }

  /// Reads the joint's contributors, their shares, and for how long it has had no contributor.
  bool origin(JointResource& joint) {
    if (text(",\"contributors\":[") && !contributors(joint.contributors)) return false;
    if (text(",\"shares\":[")) {
      if (!shares(",", "]", *share_list_, joint)) return false;
    } else {
      joint.shares = *share_list_->read(std::nullopt, joint.contributors);
    }
    return !text(",\"age\":") || duration(joint.age);
  }

  bool point(JointResource& joint) {
    auto& p = joint.position;
    return text("x\":") && decimal<kPositionDecimals>(p.x()) && text(",\"y\":") &&
           decimal<kPositionDecimals>(p.y()) && text(",\"z\":") &&
           decimal<kPositionDecimals>(p.z());
  }

  /// Starts after "ray".
  bool ray(JointResource& joint) {
    auto& p = joint.position;
    joint.measurement = Measurement::Ray;
    return text("X\":") && decimal<kRayDecimals>(p.x()) && text(",\"rayY\":") &&
           decimal<kRayDecimals>(p.y()) && text(",\"rayZ\":") && decimal<kRayDecimals>(p.z()) &&
           std::abs(p.norm() - 1.0) <= kRayTolerance;
  }

  /// Starts after the name of the covariance's first term; stops after the opening quote of the
  /// next name.
  bool covariance(Covariance& out) {
    std::array<double, Covariance::kTerms> upper{};
    for (std::size_t i = 0; i < upper.size(); ++i) {
      if (i > 0 && (!text(kCovarianceNames[i]) || !text("\":"))) return false;
      if (!decimal<kVarianceDecimals>(upper[i]) || !text(",\"")) return false;
    }
    out = Covariance(upper);
    return out.plausible();
  }

  bool contributors(std::uint64_t& bits) {
    return text("]") || (subset(frame_.sensors, ",", bits) && text("]"));
  }

  bool orientation(Eigen::Quaterniond& q) {
    if (!decimal<kQuaternionDecimals>(q.x()) || !text(",\"qy\":") ||
        !decimal<kQuaternionDecimals>(q.y()) || !text(",\"qz\":") ||
        !decimal<kQuaternionDecimals>(q.z()) || !text(",\"qw\":") ||
        !decimal<kQuaternionDecimals>(q.w()) || !text(",\"")) {
      return false;
    }
    return nearly_unit(q) || std::abs(q.norm() - 1.0) <= kUnitTolerance;
  }

  std::string_view names_;
  FrameResource frame_;
  std::optional<ShareList> share_list_;  ///< Of the frame's sensors, once these are read.
};

}  // namespace

std::optional<FrameResource> read_json_template(std::string_view json) {
  return JsonTemplate(json).run();
}

}  // namespace chorus::resource
