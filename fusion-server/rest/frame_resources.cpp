#include "fusion-server/rest/frame_resources.h"

#include <charconv>
#include <utility>

#include "fusion-server/wire/snapshot_resource.h"

namespace chorus::rest {
namespace {

Result<std::uint64_t> parse_number(const std::string& text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || text.empty()) {
    return fail(ErrorCode::NotFound, text, "a whole number is wanted here");
  }
  return value;
}

/// Revalidated, and without an immutable twin.
http::DocumentOptions version_of(const resource::FrameResource& frame, const RestContext& context) {
  auto options = resource::latest_options(frame, context.instance);
  options.content_location.clear();
  return options;
}

Error not_yet(std::string where) {
  return {ErrorCode::Unavailable, std::move(where),
          "nothing has been fused yet; ask again in a second"};
}

}  // namespace

resource::Place place_of(const RestContext& context, std::string path, std::string names) {
  return {std::move(path), std::move(names), context.root};
}

FrameResources::FrameResources(RestContext context, std::size_t ring_capacity)
    : context_(std::move(context)),
      ring_(ring_capacity),
      live_(std::make_shared<http::LiveDocument>()) {}

void FrameResources::publish(std::shared_ptr<const Snapshot> snapshot) {
  const auto frame = std::make_shared<const resource::FrameResource>(wire::to_resource(*snapshot));
  ring_.push(frame);
  live_->publish(resource::frame_document(frame, place_of(context_, "frame"),
                                          resource::latest_options(*frame, context_.instance)));
}

void FrameResources::amend(const Snapshot& snapshot) {
  ring_.amend(std::make_shared<const resource::FrameResource>(wire::to_resource(snapshot)));
}

Result<http::DocumentPtr> FrameResources::frame_at(const http::Request& request) const {
  const std::string amendments = std::to_string(ring_.amendments());
  const auto at = request.query.find("at");
  auto frame = ring_.at(at == request.query.end() ? std::string() : at->second);
  if (!frame) return pass(frame);
  http::DocumentOptions options;
  options.version =
      context_.instance + "-" + std::to_string(to_unix_ns((*frame)->captured)) + "-" + amendments;
  return resource::frame_document(std::move(*frame), place_of(context_, "frame"),
                                  std::move(options));
}

Result<http::DocumentPtr> FrameResources::frame_of(const std::string& sequence) const {
  const auto number = parse_number(sequence);
  if (!number) return pass(number);
  auto frame = ring_.find(*number);
  if (!frame) return pass(frame);
  auto options = resource::kept_options(**frame, context_.instance);
  return resource::frame_document(std::move(*frame), place_of(context_, "frames/" + sequence),
                                  std::move(options));
}

Result<http::DocumentPtr> FrameResources::skeletons() const {
  const resource::FramePtr frame = ring_.newest();
  if (!frame) return tl::unexpected(not_yet("skeletons/"));
  return resource::skeletons_document(*frame, place_of(context_, "skeletons/"),
                                      version_of(*frame, context_));
}

Result<http::DocumentPtr> FrameResources::skeleton(const std::string& id) const {
  const auto number = parse_number(id);
  if (!number) return pass(number);
  const resource::FramePtr frame = ring_.newest();
  if (!frame) return tl::unexpected(not_yet("skeletons/" + id));
  auto document = resource::skeleton_document(frame, *number, place_of(context_, "skeletons/" + id),
                                              version_of(*frame, context_));
  if (document) return document;
  return fail(ErrorCode::NotFound, "skeletons/" + id, "no such body in the latest frame");
}

void FrameResources::add_routes(http::Router& router) {
  router.live("/frame", live_);
  router.by_query("/frame", "at", [this](const http::Request& request, const http::PathParams&) {
    return frame_at(request);
  });
  router.get("/frames/{seq}", [this](const http::Request&, const http::PathParams& params) {
    return frame_of(params.at("seq"));
  });
  router.get("/skeletons/",
             [this](const http::Request&, const http::PathParams&) { return skeletons(); });
  router.get("/skeletons/{id}", [this](const http::Request&, const http::PathParams& params) {
    return skeleton(params.at("id"));
  });
}

}  // namespace chorus::rest
