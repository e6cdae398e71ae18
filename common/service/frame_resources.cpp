#include "common/service/frame_resources.h"

#include <memory>
#include <utility>

#include "common/base/parse.h"
#include "common/resource/frame_between.h"

namespace chorus::service {
namespace {

using http::DocumentOptions;
using http::PathParams;
using http::Request;
using resource::FrameResource;

FramePtr frame_in(std::shared_ptr<const void> value) {
  return std::static_pointer_cast<const FrameResource>(std::move(value));
}

std::shared_ptr<const void> between_frames(const void* before, const void* after,
                                           Timestamp instant) {
  return std::make_shared<const FrameResource>(
      resource::between(*static_cast<const FrameResource*>(before),
                        *static_cast<const FrameResource*>(after), instant));
}

http::DocumentPtr document_of_frame(std::shared_ptr<const void> value, const resource::Place& place,
                                    DocumentOptions options) {
  return resource::frame_document(frame_in(std::move(value)), place, std::move(options));
}

constexpr ServedKind kServedFrames{{"frame", "frames/", "frame", between_frames},
                                   document_of_frame};

/// Options for the document of a body, which clients revalidate, and of which there is no immutable
/// copy.
DocumentOptions body_options(const FrameResource& frame, const Serving& serving) {
  DocumentOptions options = resource::latest_options(frame, serving.run);
  options.content_location.clear();
  return options;
}

std::string bodies_in(const FrameResource& frame) {
  std::string ids;
  for (const auto& body : frame.bodies) ids += (ids.empty() ? "" : ", ") + std::to_string(body.id);
  return ids.empty() ? "no body is in the latest frame"
                     : "in the latest frame are only the bodies " + ids;
}

}  // namespace

FrameResources::FrameResources(Serving serving, const DocumentHistory& history)
    : frames_(std::move(serving), history, kServedFrames) {}

void FrameResources::predict_with(std::function<FramePtr()> now) {
  frames_.predict_with([now = std::move(now)] {
    auto frame = now();
    return frame ? resource::document_of_value(std::move(frame)) : Document{};
  });
}

FramePtr FrameResources::newest() const { return frame_in(frames_.newest().value); }

FrameResources::Answer FrameResources::skeletons() const {
  const FramePtr frame = newest();
  if (!frame) return not_yet("/skeletons/", "frame");
  return resource::skeletons_document(*frame, frames_.serving().place("skeletons/"),
                                      body_options(*frame, frames_.serving()));
}

FrameResources::Answer FrameResources::skeleton(const std::string& id) const {
  const std::string where = "/skeletons/" + id;
  const FramePtr frame = newest();
  if (!frame) return not_yet(where, "frame");
  if (const auto number = parse_name_number(id)) {
    const auto document =
        resource::skeleton_document(frame, *number, frames_.serving().place("skeletons/" + id),
                                    body_options(*frame, frames_.serving()));
    if (document) return document;
  }
  return fail(ErrorCode::NotFound, where, bodies_in(*frame));
}

void FrameResources::add_routes(http::Router& router) {
  frames_.add_routes(router);
  router.get("/skeletons/", [this](const Request&, const PathParams&) { return skeletons(); });
  router.get("/skeletons/{id}",
             [this](const Request&, const PathParams& path) { return skeleton(path.at("id")); });
}

}  // namespace chorus::service
