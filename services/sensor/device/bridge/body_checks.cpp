#include "services/sensor/device/bridge/body_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace chorus::bridge {
namespace {

// No camera sees a person from this far away [m].  A distance of 2 m in millimetres or centimetres
// is above this limit.
constexpr double kFarthestBody = 100.0;
constexpr std::size_t kFewPixels = 3;  // Fewer say little about a picture.
constexpr double kCorner = 2.0;        // Normalised landmarks may lie a little outside [px].

}  // namespace

Result<void> check_distance(const Skeleton<SensorSpace>& skeleton, const At& at) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Joint& joint : skeleton.joints) {
    if (joint.seen()) nearest = std::min(nearest, joint.position.norm());
  }
  if (nearest <= kFarthestBody || std::isinf(nearest)) return {};
  return wrong(at, fmt::format("are all {:.0f} m or more from the sensor; lengths are in metres: "
                               "are these millimetres?",
                               nearest));
}

std::vector<Eigen::Vector2d> pixels_given(const nlohmann::json& pixels) {
  std::vector<Eigen::Vector2d> places;
  for (const auto& one : pixels) {
    if (one.is_null()) continue;
    const auto& at = one.is_object() ? one.at("at") : one;
    if (!at.is_array() || at.size() < 2 || !at[0].is_number() || !at[1].is_number()) continue;
    places.emplace_back(at.at(0).get<double>(), at.at(1).get<double>());
  }
  return places;
}

Result<void> check_pixels(const std::vector<Eigen::Vector2d>& pixels, const At& at) {
  const auto at_corner = [](const Eigen::Vector2d& place) {
    return place.cwiseAbs().maxCoeff() <= kCorner;
  };
  if (pixels.size() < kFewPixels || !std::ranges::all_of(pixels, at_corner)) return {};
  return wrong(at,
               "are all at the picture's corner, in pixels: are these normalised coordinates? "
               "Multiply them by width and height");
}

std::optional<bool> outside_picture(const std::vector<Eigen::Vector2d>& pixels,
                                    const Intrinsics& camera) {
  if (pixels.size() < kFewPixels) return std::nullopt;
  return std::ranges::all_of(pixels, [&](const Eigen::Vector2d& place) {
    return place.x() < 0.0 || place.x() > camera.width || place.y() < 0.0 ||
           place.y() > camera.height;
  });
}

}  // namespace chorus::bridge
