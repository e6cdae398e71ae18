// Reads the JSON that frame_json.cpp writes by following its template, as frame_fast_reader.cpp
// does for Turtle.
#include <algorithm>

#include "common/body/bones.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_template.h"

namespace chorus::resource {
namespace {

class JsonTemplate : FrameTemplate<Style::Json> {
 public:
  using FrameTemplate::FrameTemplate;

  std::optional<FrameResource> run() {
    if (!head() || !bodies() || !props() || !text("}")) return std::nullopt;
    text("\n");
    if (!at_end() || !slots_differ()) return std::nullopt;
    return std::move(frame_);
  }

 private:
  bool head() {
    return text("{\"@id\":\"") && folder("frame\",\"@type\":\"Frame\",\"sequence\":", names_) &&
           integer(frame_.sequence) && captured(frame_.captured) && origin();
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
    const auto twin = std::ranges::find(frame_.bodies, id, &BodyResource::id);
    if (&*twin != &body || !fields(BodyFields{}, body) || !captured(body.captured)) return false;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!text(i == 0 ? ",\"joints\":{" : ",") || !text(kJsonOpenings[i]) || !text(iri))
        return false;
      if (!text(kPlainTypes[i]) && !untyped(i)) return false;
      if (!joint(body.joints[i]) || !text("}")) return false;
    }
    return text("}}");
  }

  bool props() {
    if (!text(",\"heldProps\":[")) return true;
    do {
      std::string_view name;
      if (!text("{\"@id\":\"") || !text(names_) || !text("frame") || !text(kPropMark) ||
          !word(name) || !text("\",\"@type\":\"HeldProp\"") || !prop(name) || !text("}"))
        return false;
    } while (text(","));
    return text("]");
  }

  /// Recordings of earlier versions lack the type.
  bool untyped(std::size_t i) { return text("#") && text(kJointNames[i]) && text("\""); }

  /// Reads an id; ids that a double cannot represent exactly are in quotes.
  bool id_number(std::uint64_t& id) {
    const bool quoted = text("\"");
    return integer(id) && (!quoted || text("\""));
  }

  std::string_view names_;
};

}  // namespace

std::optional<FrameResource> read_json_template(std::string_view json) {
  return JsonTemplate(json).run();
}

}  // namespace chorus::resource
