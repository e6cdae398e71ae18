#include "common/resource/frame_document.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/resource/document.h"
#include "common/resource/link_lines.h"
#include "common/resource/node.h"

namespace chorus::resource {
namespace {

constexpr std::string_view kArvida = "arvida";
constexpr std::string_view kPose = "pose";
constexpr std::string_view kKept = "frames/";

}  // namespace

http::DocumentOptions latest_options(const FrameResource& frame, const std::string& run) {
  return latest_options(Document{frame.sequence, frame.captured, nullptr}, kKept, run);
}

http::DocumentOptions kept_options(const FrameResource& frame, const std::string& run) {
  return kept_options(Document{frame.sequence, frame.captured, nullptr}, run);
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
  variants.push_back({std::string(media_type(Format::Json)), [frame] { return write_pose(*frame); },
                      std::string(kPose)});
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
