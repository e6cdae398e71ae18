#include "common/resource/image_resource.h"

#include <utility>

namespace chorus::resource {

Node image_node(const CameraImage& image, std::string iri) {
  constexpr int kPixelDigits = 3;
  constexpr int kDistortionDigits = 6;
  constexpr double kMetresPerDepthUnit = 0.001;  // The PNG has 16-bit millimetres (camera_image.h).
  const Intrinsics& camera = image.intrinsics;
  std::vector<Decimal> distortion;
  for (const double k : camera.distortion) distortion.push_back({k, kDistortionDigits});
  Node node{std::move(iri),
            {"Image"},
            {{"captured", image.captured},
             {"capturedNanoseconds", to_unix_ns(image.captured)},
             {"mediaType", image.media_type},
             {"width", std::int64_t{camera.width}},
             {"height", std::int64_t{camera.height}},
             {"fx", Decimal{camera.fx, kPixelDigits}},
             {"fy", Decimal{camera.fy, kPixelDigits}},
             {"cx", Decimal{camera.cx, kPixelDigits}},
             {"cy", Decimal{camera.cy, kPixelDigits}},
             {"distortion", std::move(distortion)}}};
  if (camera.model == LensModel::Fisheye) node.properties.emplace_back("lensModel", "fisheye");
  if (image.media_type == "image/png") {
    node.properties.emplace_back("metresPerUnit", Decimal{kMetresPerDepthUnit, 4});
  }
  return node;
}

}  // namespace chorus::resource
