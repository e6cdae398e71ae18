// What the service knows after one capture: immutable, and shared by all requests until the next
// capture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/http/document.h"
#include "common/resource/frame_resource.h"
#include "common/sensor/frame_source.h"
#include "common/service/serving.h"
#include "services/sensor/lazy_image.h"

namespace chorus::sensor_service {

struct LatestCapture {
  std::shared_ptr<const resource::FrameResource> frame;
  std::optional<FloorPlane> floor;
  std::uint64_t floor_version = 0;         ///< Counts changes of the floor plane.
  std::shared_ptr<const LazyImage> color;  ///< Null if the device has no colour image.
  std::shared_ptr<const LazyImage> depth;
};
using LatestCapturePtr = std::shared_ptr<const LatestCapture>;

/// What is known after `capture`.  A capture without a floor plane gets that of `before`, which may
/// be null, unless it begins anew.
[[nodiscard]] LatestCapturePtr latest_capture(Capture capture, const LatestCapture* before);

// The documents about one capture.

[[nodiscard]] Result<http::DocumentPtr> floor_plane(const LatestCapture& latest,
                                                    const service::Serving& serving);
/// `/images/`: the available images and the camera model of each.
[[nodiscard]] http::DocumentPtr image_list(const LatestCapture& latest,
                                           const service::Serving& serving);
/// The bytes of one image; an Error when its encoder failed.
[[nodiscard]] Result<http::DocumentPtr> image_document(const LazyImage& image,
                                                       std::uint64_t sequence,
                                                       const service::Serving& serving);

}  // namespace chorus::sensor_service
