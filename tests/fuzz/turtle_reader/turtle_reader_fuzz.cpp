// Reads any bytes as a frame in every format: a frame or an Error, never a crash; an accepted frame
// can be written and read again, and template readers never accept what the parsers refuse.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "common/rdf/turtle_reader.h"
#include "common/resource/floor_plane_resource.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_resource.h"

namespace {

using chorus::resource::Format;

void require(bool holds) {
  if (!holds) std::abort();
}

void round_trip(std::string_view bytes, Format format) {
  const auto frame = read_frame(bytes, format);
  if (!frame) return require(!frame.error().message.empty());
  for (const Format other : chorus::resource::kFormats) {
    require(read_frame(write(*frame, other), other).has_value());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  round_trip(text, Format::Turtle);
  round_trip(text, Format::Json);
  if (chorus::resource::read_template(text)) {
    require(chorus::resource::read_rdf_frame(text, Format::Turtle).has_value());
  }
  if (chorus::resource::read_json_template(text)) {
    require(chorus::resource::read_json_frame(text).has_value());
  }
  (void)chorus::rdf::read_graph(text, {chorus::rdf::Syntax::NTriples, {}, {}});
  (void)chorus::rdf::read_graph(text, {chorus::rdf::Syntax::Turtle, "http://h/frame", {}});
  (void)chorus::resource::read_floor_plane(text, Format::Turtle);
  return 0;
}
