#include "services/sensor/sight.h"

#include <charconv>
#include <utility>
#include <vector>

#include "common/resource/floor_plane_resource.h"
#include "common/resource/frame_document.h"
#include "common/resource/image_resource.h"
#include "common/resource/node.h"

namespace chorus::sensor_service {

namespace {

using http::DocumentOptions;
using http::DocumentPtr;
using resource::Format;
using resource::FrameResource;
using resource::Node;
using resource::Place;
using resource::Ref;

// A frame never changes, but a restarted service uses its number again: caches may keep it for
// about as long as the service itself might, not for ever.
constexpr std::string_view kImmutable = "public, max-age=60, immutable";

std::shared_ptr<const LazyImage> lazy(std::function<Result<CameraImage>()> encode) {
  return encode ? std::make_shared<const LazyImage>(std::move(encode)) : nullptr;
}

/// Of everything that changes with each frame.
DocumentOptions options_of(const Sight& sight, const Serving& serving) {
  DocumentOptions options;
  options.version = std::to_string(sight.frame->sequence) + "." + serving.run;
  options.captured = sight.frame->captured;
  return options;
}

/// An image with the camera model behind it; one that cannot be encoded is left out.
void add_image(Node& list, std::vector<Ref>& contains, const char* key, const LazyImage* image) {
  if (image == nullptr || !image->get()) return;
  const std::string name = key == std::string_view("colorImage") ? "color" : "depth";
  contains.push_back({name});
  list.properties.emplace_back(key, resource::image_node(*image->get(), name));
}

Node image_list_node(const Sight& sight) {
  Node list{"", {"ldp:BasicContainer"}, {{"title", std::string("Camera images")}}};
  std::vector<Ref> contains;
  add_image(list, contains, "colorImage", sight.color.get());
  add_image(list, contains, "depthImage", sight.depth.get());
  list.properties.emplace_back("contains", std::move(contains));
  return list;
}

std::string bodies_in(const FrameResource& frame) {
  std::string ids;
  for (const auto& body : frame.bodies) ids += (ids.empty() ? "" : ", ") + std::to_string(body.id);
  return ids.empty() ? "no body is in sight" : "in sight are only the bodies " + ids;
}

}  // namespace

SightPtr see(Capture capture, const Sight* before) {
  auto sight = std::make_shared<Sight>();
  sight->frame = std::make_shared<const FrameResource>(resource::to_resource(capture.frame));
  sight->floor = capture.frame.floor;
  if (before != nullptr) {
    if (!sight->floor) sight->floor = before->floor;
    sight->floor_version = before->floor_version + (sight->floor != before->floor ? 1 : 0);
  }
  sight->color = lazy(std::move(capture.color));
  sight->depth = lazy(std::move(capture.depth));
  return sight;
}

DocumentPtr latest_frame(const Sight& sight, const Serving& serving) {
  return resource::frame_document(sight.frame, {.path = "frame", .root = serving.root},
                                  resource::latest_options(*sight.frame, serving.run));
}

DocumentPtr numbered_frame(const Sight& sight, const Serving& serving) {
  DocumentOptions options = resource::kept_options(*sight.frame, serving.run);
  options.cache_control = kImmutable;
  const Place place{.path = "frames/" + std::to_string(sight.frame->sequence),
                    .root = serving.root};
  return resource::frame_document(sight.frame, place, std::move(options));
}

DocumentPtr skeleton_list(const Sight& sight, const Serving& serving) {
  return resource::skeletons_document(*sight.frame, {.path = "skeletons/", .root = serving.root},
                                      options_of(sight, serving));
}

Result<DocumentPtr> skeleton(const Sight& sight, const std::string& id, const Serving& serving) {
  std::uint64_t wanted = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), wanted);
  const bool number = error == std::errc{} && end == id.data() + id.size();
  if (number && id == std::to_string(wanted)) {
    const Place place{.path = "skeletons/" + id, .root = serving.root};
    if (auto found =
            resource::skeleton_document(sight.frame, wanted, place, options_of(sight, serving))) {
      return found;
    }
  }
  return fail(ErrorCode::NotFound, "/skeletons/" + id, bodies_in(*sight.frame));
}

Result<DocumentPtr> floor_plane(const Sight& sight, const Serving& serving) {
  if (!sight.floor) {
    return fail(ErrorCode::NotFound, "/floor-plane",
                "this sensor does not know where the floor is");
  }
  DocumentOptions options;
  options.version = std::to_string(sight.floor_version) + "." + serving.run;
  return resource::document_of(resource::floor_plane_node(*sight.floor, sight.frame->space),
                               std::move(options), {.path = "floor-plane", .root = serving.root});
}

DocumentPtr image_list(const Sight& sight, const Serving& serving) {
  const auto shared = std::make_shared<const Sight>(sight);
  DocumentOptions options = options_of(sight, serving);
  options.container = true;
  std::vector<http::Variant> variants;
  for (const Format format : resource::kFormats) {
    variants.push_back(
        {std::string(resource::media_type(format)), [shared, format, root = serving.root] {
           return resource::write(image_list_node(*shared), format,
                                  {.path = "images/", .root = root});
         }});
  }
  return std::make_shared<const http::Document>(std::move(variants), std::move(options));
}

Result<DocumentPtr> image_document(const LazyImage& image, std::uint64_t sequence,
                                   const Serving& serving) {
  const auto& encoded = image.get();
  if (!encoded) return pass(encoded);
  DocumentOptions options;
  options.version = std::to_string(sequence) + "." + serving.run;
  options.rdf_source = false;
  options.captured = encoded->captured;
  options.headers = {{"Link", "</images/>; rel=\"describedby\""}};
  return http::make_document(encoded->media_type, encoded->bytes, std::move(options));
}

}  // namespace chorus::sensor_service
