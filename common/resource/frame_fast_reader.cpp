// Reads the bytes that frame_turtle.cpp writes by following its template, which is 25 times faster
// than a parser.
//
// Nothing is refused here: at the first unexpected byte, or at a value that is not clearly valid,
// the result is nullopt.  Then the parser reads the document from the start and reports mistakes.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "common/body/bones.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_parts.h"
#include "common/resource/joint_texts.h"
#include "common/resource/template_text.h"

namespace chorus::resource {
namespace {

constexpr std::string_view kHead =
    "@prefix ch: <https://w3id.org/chorus-tracking/ns#> .\n"
    "@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n\n<";

/// Each step returns false at anything unexpected; the caller then gives up.
class Template : TemplateText {
 public:
  using TemplateText::TemplateText;

  std::optional<FrameResource> run() {
    if (!head() || !body_links()) return std::nullopt;
    for (BodyResource& body : frame_.bodies) {
      if (!this->body(body)) return std::nullopt;
    }
    if (!at_end()) return std::nullopt;
    return std::move(frame_);
  }

 private:
  bool captured(Timestamp& out) {
    return text(" ;\n  ch:captured \"") &&
           times("\"^^xsd:dateTime ;\n  ch:capturedNanoseconds ", out);
  }

  bool head() {
    std::uint64_t named = 0;
    if (!text(kHead) || !folder("frames/", names_) || !integer(named)) return false;
    scoped_ = {names_.data(), static_cast<std::size_t>(here() - names_.data())};
    if (!text("> a ch:Frame ;\n  ch:sequence ") || !same(named)) return false;
    frame_.sequence = named;
    std::string_view source;
    if (!captured(frame_.captured)) return false;
    if (!text(" ;\n  ch:source ") || !name(source) || !text(" ;\n  ch:space ch:")) return false;
    frame_.source = source;
    if (text("WorldSpace")) {
      frame_.space = SpaceKind::World;
    } else if (!text("SensorSpace")) {
      return false;
    }
    if (text(" ;\n  ch:sensor ") && !names(", ", frame_.sensors)) return false;
    share_list_.emplace(frame_.sensors);
    return true;
  }

  bool same(std::uint64_t id) {
    std::uint64_t read = 0;
    return integer(read) && read == id;
  }

  bool body_name(std::uint64_t id) { return text(scoped_) && text("#") && same(id); }

  bool body_links() {
    if (text(" .\n")) return true;
    if (!text(" ;\n  ch:body ")) return false;
    std::array<std::uint64_t, kMaxBodies> ids;
    std::size_t count = 0;
    do {
      std::uint64_t id = 0;
      if (!text("<") || !text(scoped_) || !text("#") || !integer(id) || !text(">")) return false;
      const auto end = ids.begin() + static_cast<std::ptrdiff_t>(count);
      if (count == kMaxBodies || std::find(ids.begin(), end, id) != end) return false;
      ids[count++] = id;
    } while (text(", "));
    frame_.bodies.resize(count);  // All at once: bodies are large, and moving them costs.
    for (std::size_t i = 0; i < count; ++i) frame_.bodies[i].id = ids[i];
    return text(" .\n");
  }

  bool body(BodyResource& body) {
    const char* const begin = here() + 2;
    if (!text("\n<") || !body_name(body.id)) return false;
    const std::string_view iri(begin, static_cast<std::size_t>(here() - begin));
    if (!text("> a ch:Skeleton ;\n  ch:of <") || !text(names_) || !text("skeletons/") ||
        !same(body.id) || !text("> ;\n  ch:bodyId ") || !same(body.id)) {
      return false;
    }
    if (text(" ;\n  ch:slot ") && !slot(frame_.bodies, body.slot)) return false;
    if (text(" ;\n  ch:sidesConfidence ") && !confidence(body.sides_confidence)) return false;
    if (text(" ;\n  ch:carriedFor ") && !duration(body.carried_for)) return false;
    if (text(" ;\n  ch:smoothedOver ") && !duration(body.smoothed_over)) return false;
    if (!captured(body.captured) || !text(" ;\n  ch:joint ")) return false;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!text(i == 0 ? "<" : ", <") || !text(iri) || !text(kTurtleLinks[i])) return false;
    }
    if (!text(" .\n")) return false;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!text("\n<") || !text(iri) || !text(kTurtleHeads[i]) || !text("  ch:")) return false;
      if (!joint(body.joints[i]) || !text(" .\n")) return false;
    }
    return true;
  }

  /// Starts after the "ch:" of the first property; stops before the final " .".
  bool joint(JointResource& joint) {
    if (text("state ch:NotTracked")) return true;
    if (!(text("ray") ? ray(joint) : point(joint)) || !text(" ;\n  ch:")) return false;
    if (text("qx ") && !orientation(joint.orientation)) return false;
    if (!text("state ch:")) return false;
    joint.state = text("Tracked") ? JointState::Tracked : JointState::Inferred;
    if (joint.state == JointState::Inferred && !text("Inferred")) return false;
    if (text(" ;\n  ch:variance ")) {
      double variance = 0.0;
      if (!decimal<kVarianceDecimals>(variance) || variance < 0.0) return false;
      joint.variance = variance;
    }
    if (text(" ;\n  ch:cxx ") && !covariance(joint.covariance)) return false;
    return origin(joint);
  }

  /// The joint's contributors, their shares, and for how long there has been no contributor.
  bool origin(JointResource& joint) {
    if (text(" ;\n  ch:contributor ") && !subset(frame_.sensors, ", ", joint.contributors))
      return false;
    if (text(" ;\n  ch:shares (")) {
      if (!shares(" ", ")", *share_list_, joint)) return false;
    } else {
      joint.shares = *share_list_->read(std::nullopt, joint.contributors);
    }
    return !text(" ;\n  ch:age ") || duration(joint.age);
  }

  bool point(JointResource& joint) {
    auto& p = joint.position;
    return text("x ") && decimal<kPositionDecimals>(p.x()) && text(" ; ch:y ") &&
           decimal<kPositionDecimals>(p.y()) && text(" ; ch:z ") &&
           decimal<kPositionDecimals>(p.z());
  }

  /// Starts after "ray".
  bool ray(JointResource& joint) {
    auto& p = joint.position;
    joint.measurement = Measurement::Ray;
    return text("X ") && decimal<kRayDecimals>(p.x()) && text(" ; ch:rayY ") &&
           decimal<kRayDecimals>(p.y()) && text(" ; ch:rayZ ") && decimal<kRayDecimals>(p.z()) &&
           std::abs(p.norm() - 1.0) <= kRayTolerance;
  }

  /// Starts after the name of the covariance's first term.
  bool covariance(Covariance& out) {
    std::array<double, Covariance::kTerms> upper{};
    for (std::size_t i = 0; i < upper.size(); ++i) {
      if (i > 0 && (!text(" ; ch:") || !text(kCovarianceNames[i]) || !text(" "))) return false;
      if (!decimal<kVarianceDecimals>(upper[i])) return false;
    }
    out = Covariance(upper);
    return out.plausible();
  }

  bool orientation(Eigen::Quaterniond& q) {
    if (!decimal<kQuaternionDecimals>(q.x()) || !text(" ; ch:qy ") ||
        !decimal<kQuaternionDecimals>(q.y()) || !text(" ; ch:qz ") ||
        !decimal<kQuaternionDecimals>(q.z()) || !text(" ; ch:qw ") ||
        !decimal<kQuaternionDecimals>(q.w()) || !text(" ;\n  ch:")) {
      return false;
    }
    return nearly_unit(q) || std::abs(q.norm() - 1.0) <= kUnitTolerance;
  }

  std::string_view names_;
  std::string_view scoped_;  ///< The IRI of the frame itself: names_, "frames/" and the sequence.
  FrameResource frame_;
  std::optional<ShareList> share_list_;  ///< Of the frame's sensors, once these are read.
};

}  // namespace

std::optional<FrameResource> read_template(std::string_view turtle) {
  return Template(turtle).run();
}

Result<FrameResource> read_frame(std::string_view bytes, Format format) {
  // The parsers' size limit applies here too (proto/README.md).
  constexpr std::size_t kMaxBytes = 2'000'000;
  const bool small = bytes.size() <= kMaxBytes;
  if (format == Format::Turtle && small) {
    if (auto frame = read_template(bytes)) return *std::move(frame);
  }
  if (format == Format::Json && small) {
    if (auto frame = read_json_template(bytes)) return *std::move(frame);
  }
  const bool json = format == Format::Json || format == Format::JsonLd;
  return json ? read_json_frame(bytes) : read_rdf_frame(bytes, format);
}

}  // namespace chorus::resource
