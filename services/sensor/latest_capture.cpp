#include "services/sensor/latest_capture.h"

#include <utility>
#include <vector>

#include "common/resource/floor_plane_resource.h"
#include "common/resource/image_resource.h"
#include "common/resource/link_lines.h"
#include "common/resource/node.h"

namespace chorus::sensor_service {

namespace {

using http::DocumentOptions;
using http::DocumentPtr;
using resource::Format;
using resource::FrameResource;
using resource::Node;
using resource::Ref;

std::shared_ptr<const LazyImage> lazy(std::function<Result<CameraImage>()> encode) {
  return encode ? std::make_shared<const LazyImage>(std::move(encode)) : nullptr;
}

/// The options of every document that changes with each frame.
DocumentOptions options_of(const LatestCapture& latest, const service::Serving& serving) {
  DocumentOptions options;
  options.version = std::to_string(latest.frame->sequence) + "." + serving.run;
  options.captured = latest.frame->captured;
  return options;
}

/// Adds an image with its camera model; an image that cannot be encoded is left out.
void add_image(Node& list, std::vector<Ref>& contains, const char* key, const LazyImage* image) {
  if (image == nullptr || !image->get()) return;
  const std::string name = key == std::string_view("colorImage") ? "color" : "depth";
  contains.push_back({name});
  list.properties.emplace_back(key, resource::image_node(*image->get(), name));
}

Node image_list_node(const LatestCapture& latest) {
  Node list{"", {"ldp:BasicContainer"}, {{"title", std::string("Camera images")}}};
  std::vector<Ref> contains;
  add_image(list, contains, "colorImage", latest.color.get());
  add_image(list, contains, "depthImage", latest.depth.get());
  list.properties.emplace_back("contains", std::move(contains));
  return list;
}

}  // namespace

LatestCapturePtr latest_capture(Capture capture, const LatestCapture* before) {
  auto latest = std::make_shared<LatestCapture>();
  latest->frame = std::make_shared<const FrameResource>(resource::to_resource(capture.frame));
  latest->floor = capture.frame.floor;
  if (before != nullptr) {
    if (!latest->floor && !capture.begins_anew) latest->floor = before->floor;
    latest->floor_version = before->floor_version + (latest->floor != before->floor ? 1 : 0);
  }
  latest->color = lazy(std::move(capture.color));
  latest->depth = lazy(std::move(capture.depth));
  return latest;
}

Result<DocumentPtr> floor_plane(const LatestCapture& latest, const service::Serving& serving) {
  if (!latest.floor) {
    return fail(ErrorCode::NotFound, "/floor-plane",
                "this sensor does not know where the floor is");
  }
  DocumentOptions options;
  options.version = std::to_string(latest.floor_version) + "." + serving.run;
  return resource::document_of(resource::floor_plane_node(*latest.floor, latest.frame->space),
                               std::move(options), serving.place("floor-plane"));
}

DocumentPtr image_list(const LatestCapture& latest, const service::Serving& serving) {
  const auto shared = std::make_shared<const LatestCapture>(latest);
  DocumentOptions options = options_of(latest, serving);
  std::vector<http::Variant> variants;
  for (const Format format : resource::kFormats) {
    variants.push_back({std::string(resource::media_type(format)),
                        [shared, format, here = serving.place("images/")] {
                          return resource::write(image_list_node(*shared), format, here);
                        }});
  }
  return std::make_shared<const http::Document>(
      resource::linked(std::move(variants), resource::Kind::Container), std::move(options));
}

Result<DocumentPtr> image_document(const LazyImage& image, std::uint64_t sequence,
                                   const service::Serving& serving) {
  const auto& encoded = image.get();
  if (!encoded) return pass(encoded);
  DocumentOptions options;
  options.version = std::to_string(sequence) + "." + serving.run;
  options.captured = encoded->captured;
  options.headers = {{"Link", "</images/>; rel=\"describedby\""}};
  return resource::other_document(encoded->media_type, encoded->bytes, std::move(options));
}

}  // namespace chorus::sensor_service
