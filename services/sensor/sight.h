// What the service knows after one capture: immutable, shared by all requests until the next one.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/http/document.h"
#include "common/resource/frame_resource.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/lazy_image.h"

namespace chorus::sensor_service {

struct Sight {
  std::shared_ptr<const resource::FrameResource> frame;
  std::optional<FloorPlane> floor;
  std::uint64_t floor_version = 0;         ///< Counts changes of the floor plane.
  std::shared_ptr<const LazyImage> color;  ///< Null: the device has none.
  std::shared_ptr<const LazyImage> depth;
};
using SightPtr = std::shared_ptr<const Sight>;

/// The sight of a capture; `before` (may be null) lends its floor plane when the capture has none.
[[nodiscard]] SightPtr see(Capture capture, const Sight* before);

/// How this run of the service names itself.
struct Serving {
  std::string
      run;  ///< In every ETag: a validator of an earlier run never fits a document of this one.
  std::string root = "http://localhost/";  ///< Absolute IRI of `/`, for N-Triples.
};

// The documents of one sight.

[[nodiscard]] http::DocumentPtr latest_frame(const Sight& sight, const Serving& serving);
[[nodiscard]] http::DocumentPtr numbered_frame(const Sight& sight, const Serving& serving);
[[nodiscard]] http::DocumentPtr skeleton_list(const Sight& sight, const Serving& serving);
/// NotFound names the bodies there are.
[[nodiscard]] Result<http::DocumentPtr> skeleton(const Sight& sight, const std::string& id,
                                                 const Serving& serving);
[[nodiscard]] Result<http::DocumentPtr> floor_plane(const Sight& sight, const Serving& serving);
/// `/images/`: which images there are, and the camera model behind each.
[[nodiscard]] http::DocumentPtr image_list(const Sight& sight, const Serving& serving);
/// One image as bytes; an encoder that fails is an Error.
[[nodiscard]] Result<http::DocumentPtr> image_document(const LazyImage& image,
                                                       std::uint64_t sequence,
                                                       const Serving& serving);

}  // namespace chorus::sensor_service
