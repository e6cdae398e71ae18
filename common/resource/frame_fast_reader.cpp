// Reads the bytes that frame_turtle.cpp writes by following its template, which is 25 times faster
// than a parser.
#include <algorithm>
#include <array>

#include "common/body/bones.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_template.h"

namespace chorus::resource {
namespace {

constexpr std::string_view kHead =
    "@prefix ch: <https://w3id.org/chorus-tracking/ns#> .\n"
    "@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n\n<";

class TurtleTemplate : FrameTemplate<Style::Turtle> {
 public:
  using FrameTemplate::FrameTemplate;

  std::optional<FrameResource> run() {
    if (!head() || !body_links()) return std::nullopt;
    for (BodyResource& body : frame_.bodies) {
      if (!this->body(body)) return std::nullopt;
    }
    for (const std::string_view name : props_) {
      if (!text("\n<") || !text(scoped_) || !text(kPropMark) || !text(name) ||
          !text("> a ch:HeldProp") || !prop(name) || !text(" .\n"))
        return std::nullopt;
    }
    if (!at_end() || !slots_differ()) return std::nullopt;
    return std::move(frame_);
  }

 private:
  bool head() {
    std::uint64_t named = 0;
    if (!text(kHead) || !folder("frames/", names_) || !integer(named)) return false;
    scoped_ = {names_.data(), static_cast<std::size_t>(here() - names_.data())};
    if (!text("> a ch:Frame ;\n  ch:sequence ") || !same(named)) return false;
    frame_.sequence = named;
    return captured(frame_.captured) && origin() && prop_links();
  }

  bool prop_links() {
    if (!text(" ;\n  ch:heldProp ")) return true;
    do {
      std::string_view name;
      if (props_.size() == kMaxProps || !text("<") || !text(scoped_) || !text(kPropMark) ||
          !word(name) || !text(">"))
        return false;
      props_.push_back(name);
    } while (text(", "));
    return true;
  }

  bool same(std::uint64_t id) {
    std::uint64_t read = 0;
    return integer(read) && read == id;
  }

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
    if (!text("\n<") || !text(scoped_) || !text("#") || !same(body.id)) return false;
    const std::string_view iri(begin, static_cast<std::size_t>(here() - begin));
    if (!text("> a ch:Skeleton ;\n  ch:of <") || !text(names_) || !text("skeletons/") ||
        !same(body.id) || !text("> ;\n  ch:bodyId ") || !same(body.id)) {
      return false;
    }
    if (!fields(BodyFields{}, body) || !captured(body.captured)) return false;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!text(i == 0 ? " ;\n  ch:joint <" : ", <") || !text(iri) || !text(kTurtleLinks[i]))
        return false;
    }
    if (!text(" .\n")) return false;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!text("\n<") || !text(iri) || !text(kTurtleHeads[i])) return false;
      if (!joint(body.joints[i]) || !text(" .\n")) return false;
    }
    return true;
  }

  std::vector<std::string_view> props_;  ///< The names of things in hands.
  std::string_view names_;
  std::string_view scoped_;  ///< The IRI of the frame itself: names_, "frames/" and the sequence.
};

}  // namespace

std::optional<FrameResource> read_template(std::string_view turtle) {
  return TurtleTemplate(turtle).run();
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
