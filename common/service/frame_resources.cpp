#include "common/service/frame_resources.h"

#include <utility>

#include "common/base/parse.h"

namespace chorus::service {
namespace {

using http::DocumentOptions;
using http::PathParams;
using http::Request;
using resource::FrameResource;

/// Options for the document of a body, which clients revalidate, and of which there is no immutable
/// copy.
DocumentOptions body_options(const FrameResource& frame, const Serving& serving) {
  DocumentOptions options = resource::latest_options(frame, serving.run);
  options.content_location.clear();
  return options;
}

tl::unexpected<Error> not_yet(std::string where) {
  return fail(ErrorCode::Unavailable, std::move(where),
              "there has been no frame yet; ask again in a second");
}

std::string bodies_in(const FrameResource& frame) {
  std::string ids;
  for (const auto& body : frame.bodies) ids += (ids.empty() ? "" : ", ") + std::to_string(body.id);
  return ids.empty() ? "no body is in the latest frame"
                     : "in the latest frame are only the bodies " + ids;
}

}  // namespace

FrameResources::FrameResources(Serving serving, const FrameHistory& history)
    : serving_(std::move(serving)), ring_(history), live_(std::make_shared<http::LiveDocument>()) {}

void FrameResources::publish(const FramePtr& frame) {
  ring_.push(frame);
  live_->publish(resource::frame_document(frame, serving_.place("frame"),
                                          resource::latest_options(*frame, serving_.run)));
}

Result<FramePtr> FrameResources::frame_of_time(const std::string& time) const {
  if (time != "now" || !now_) return ring_.at(time);
  if (auto frame = now_()) return frame;
  return not_yet("/frame?at=now");
}

FrameResources::Answer FrameResources::frame_at(const Request& request) const {
  const std::string amendments = std::to_string(ring_.amendments());
  const auto at = request.query.find("at");
  auto frame = frame_of_time(at == request.query.end() ? std::string() : at->second);
  if (!frame) return pass(frame);
  DocumentOptions options;
  options.version =
      std::to_string(to_unix_ns((*frame)->captured)) + "-" + amendments + "." + serving_.run;
  return resource::frame_document(std::move(*frame), serving_.place("frame"), std::move(options));
}

FrameResources::Answer FrameResources::frame_of(const std::string& sequence) const {
  auto frame = ring_.find(sequence);
  if (!frame) return pass(frame);
  auto options = resource::kept_options(**frame, serving_.run);
  return resource::frame_document(std::move(*frame), serving_.place("frames/" + sequence),
                                  std::move(options));
}

FrameResources::Answer FrameResources::skeletons() const {
  const FramePtr frame = ring_.newest();
  if (!frame) return not_yet("/skeletons/");
  return resource::skeletons_document(*frame, serving_.place("skeletons/"),
                                      body_options(*frame, serving_));
}

FrameResources::Answer FrameResources::skeleton(const std::string& id) const {
  const std::string where = "/skeletons/" + id;
  const FramePtr frame = ring_.newest();
  if (!frame) return not_yet(where);
  if (const auto number = parse_name_number(id)) {
    const auto document = resource::skeleton_document(
        frame, *number, serving_.place("skeletons/" + id), body_options(*frame, serving_));
    if (document) return document;
  }
  return fail(ErrorCode::NotFound, where, bodies_in(*frame));
}

void FrameResources::add_routes(http::Router& router) {
  router.live("/frame", live_);
  router.by_query("/frame", "at",
                  [this](const Request& request, const PathParams&) { return frame_at(request); });
  router.get("/frames/{seq}",
             [this](const Request&, const PathParams& path) { return frame_of(path.at("seq")); });
  router.get("/skeletons/", [this](const Request&, const PathParams&) { return skeletons(); });
  router.get("/skeletons/{id}",
             [this](const Request&, const PathParams& path) { return skeleton(path.at("id")); });
}

}  // namespace chorus::service
