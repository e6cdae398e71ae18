#include "common/resource/frame_document.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/resource/link_lines.h"
#include "common/resource/node.h"

namespace chorus::resource {
namespace {

/// A frame never changes, but a restarted service may reuse its number.  So caches may keep a frame
/// for about as long as a service does, but not for ever.
constexpr std::string_view kImmutable = "public, max-age=60, immutable";
constexpr std::string_view kArvida = "arvida";

using Render = std::function<std::string(Format)>;

std::vector<http::Variant> variants_of(const Render& render) {
  std::vector<http::Variant> variants;
  for (const Format format : kFormats) {
    variants.push_back(
        {std::string(media_type(format)), [render, format] { return render(format); }});
  }
  return variants;
}

}  // namespace

http::DocumentOptions latest_options(const FrameResource& frame, const std::string& run) {
  http::DocumentOptions options;
  options.version = std::to_string(frame.sequence) + (run.empty() ? "" : "." + run);
  options.content_location = "frames/" + std::to_string(frame.sequence);
  options.captured = frame.captured;
  return options;
}

http::DocumentOptions kept_options(const FrameResource& frame, const std::string& run) {
  http::DocumentOptions options = latest_options(frame, run);
  options.cache_control = kImmutable;
  options.content_location.clear();
  options.captured.reset();  // The age of an old frame is of no use.
  return options;
}

http::DocumentPtr frame_document(FramePtr frame, const Place& place,
                                 http::DocumentOptions options) {
  auto variants =
      variants_of([frame, place](Format format) { return write(*frame, format, place); });
  for (const Format format : {Format::Turtle, Format::NTriples}) {
    variants.push_back({std::string(media_type(format)),
                        [frame, place, format] { return write_arvida(*frame, place, format); },
                        std::string(kArvida)});
  }
  return std::make_shared<const http::Document>(linked(std::move(variants), Kind::Source),
                                                std::move(options));
}

http::DocumentPtr skeleton_document(FramePtr frame, std::uint64_t body_id, const Place& place,
                                    http::DocumentOptions options) {
  const auto body = std::ranges::find(frame->bodies, body_id, &BodyResource::id);
  if (body == frame->bodies.end()) return nullptr;
  const auto render = [frame, &found = *body, place](Format format) {
    return write_skeleton(*frame, found, format, place);
  };
  return std::make_shared<const http::Document>(linked(variants_of(render), Kind::Source),
                                                std::move(options));
}

http::DocumentPtr skeletons_document(const FrameResource& frame, const Place& place,
                                     http::DocumentOptions options) {
  std::vector<Ref> bodies;
  for (const BodyResource& body : frame.bodies) bodies.push_back({std::to_string(body.id)});
  const Node container{"",
                       {"ldp:BasicContainer"},
                       {{"title", std::string("The bodies in the latest frame")},
                        {"frame", Ref{place.up() + place.names + "frame"}},
                        {"sequence", static_cast<std::int64_t>(frame.sequence)},
                        {"contains", bodies}}};
  return document_of(container, std::move(options), place, Kind::Container);
}

}  // namespace chorus::resource
