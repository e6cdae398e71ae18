#include "services/sensor/device/camera/lens.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace chorus::camera {
namespace {

constexpr double kSameShape = 0.01;  // Tolerance for the ratio of the sides.
constexpr double kMiddle = 0.5;      // From a pixel's corner to its centre.

Intrinsics scaled(const Intrinsics& camera, Size size) {
  const double x = static_cast<double>(size.width) / camera.width;
  const double y = static_cast<double>(size.height) / camera.height;
  Intrinsics out = camera;
  out.width = size.width;
  out.height = size.height;
  out.fx *= x;
  out.fy *= y;
  out.cx = (camera.cx + kMiddle) * x - kMiddle;
  out.cy = (camera.cy + kMiddle) * y - kMiddle;
  return out;
}

Lens from_field_of_view(const CameraSettings& settings, Size picture) {
  Lens lens;
  const double half = 0.5 * std::max(picture.width, picture.height);
  lens.camera.width = picture.width;
  lens.camera.height = picture.height;
  lens.camera.fx = lens.camera.fy = half / std::tan(settings.fov / 2.0);
  lens.camera.cx = 0.5 * picture.width - kMiddle;
  lens.camera.cy = 0.5 * picture.height - kMiddle;
  lens.focal_sigma = settings.fov_sigma / std::sin(settings.fov);  // d ln f / d fov
  return lens;
}

}  // namespace

Result<Lens> lens_for(const CameraSettings& settings, Size picture) {
  if (!settings.intrinsics) return from_field_of_view(settings, picture);
  const Intrinsics& stated = *settings.intrinsics;
  const double shape = static_cast<double>(stated.width) / stated.height;
  const double seen = static_cast<double>(picture.width) / picture.height;
  if (std::abs(seen / shape - 1.0) > kSameShape) {
    return fail(ErrorCode::InvalidArgument, "device.camera.intrinsics",
                fmt::format("is for pictures of {} x {}, and the source gives {} x {}: another "
                            "part of the view; state it for these, or choose that size",
                            stated.width, stated.height, picture.width, picture.height));
  }
  return Lens{scaled(stated, picture), settings.focal_sigma};
}

Size sent_size(Size picture, int max_side) {
  const int longer = std::max(picture.width, picture.height);
  if (longer <= max_side) return picture;
  const double scale = static_cast<double>(max_side) / longer;
  const auto shrunk = [scale](int side) {
    return std::max(1, static_cast<int>(std::lround(side * scale)));
  };
  return {shrunk(picture.width), shrunk(picture.height)};
}

Intrinsics sent_camera(const Intrinsics& camera, Size sent) {
  Intrinsics out = scaled(camera, sent);
  out.cx += kMiddle;
  out.cy += kMiddle;
  return out;
}

}  // namespace chorus::camera
