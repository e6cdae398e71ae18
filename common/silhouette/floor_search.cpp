#include "common/silhouette/floor_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/sensor/pixel_ray.h"

namespace chorus::silhouette {
namespace {

constexpr std::size_t kTried = 6;     // Of the best places, so many are refined.
constexpr double kRoughSpacing = 16;  // Of the outline's points while places are compared [px].
constexpr double kInwardsAtFirst = 4.0;
constexpr double kOutside = 30.0;  // What an outline's point without foreground inside costs [px].

struct Tried {
  Eigen::Vector3d shift;
  double cost;
};

bool hips_are_seen(const SearchView& view, const Eigen::Vector3d& hips) {
  const Eigen::Vector3d in_camera =
      camera_from_sensor_axes() * (view.world_from_sensor.inverse() * hips);
  const auto pixel = pixel_of(in_camera, view.camera);
  return pixel && view.evidence.is_foreground(*pixel);
}

/// Mean distance of the outline from edges, with a price for background within.
std::optional<double> cost_of(const SearchView& view, const Eigen::Vector3d& shift) {
  const auto capsules =
      flat_capsules(shifted(view.body, shift), view.shape, view.world_from_sensor, view.camera);
  const auto outline = outline_of(capsules, kRoughSpacing);
  double sum = 0.0;
  std::size_t count = 0;
  for (const OutlinePoint& point : outline) {
    if (point.pixel.x() < 0.0 || point.pixel.y() < 0.0 || point.pixel.x() >= view.camera.width ||
        point.pixel.y() >= view.camera.height)
      continue;
    ++count;
    sum += view.evidence.distance(point.pixel);
    if (!view.evidence.is_foreground(point.pixel - kInwardsAtFirst * point.normal)) sum += kOutside;
  }
  if (count < outline.size() / 2 || count < 8) return std::nullopt;
  return sum / static_cast<double>(count);
}

std::vector<Tried> tried_places(const SearchView& view, const FloorSearch& settings) {
  std::vector<Tried> out;
  const Eigen::Vector3d eye = view.world_from_sensor.translation();
  const Eigen::Vector3d hips = view.body[JointId::SpineBase].position;
  const int reach = static_cast<int>(settings.farthest / settings.step);
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const Eigen::Vector3d at(eye.x() + i * settings.step, hips.y(), eye.z() + j * settings.step);
      const double away = std::hypot(at.x() - eye.x(), at.z() - eye.z());
      if (away < settings.nearest || away > settings.farthest || !hips_are_seen(view, at)) continue;
      if (const auto cost = cost_of(view, at - hips)) out.push_back({at - hips, *cost});
    }
  }
  std::sort(out.begin(), out.end(), [](const Tried& a, const Tried& b) { return a.cost < b.cost; });
  return out;
}

}  // namespace

std::optional<OutlineFit> find_on_floor(const SearchView& view, const FloorSearch& settings,
                                        const OutlineSettings& outline) {
  std::optional<OutlineFit> best;
  const std::vector<Tried> places = tried_places(view, settings);
  for (std::size_t i = 0; i < std::min(kTried, places.size()); ++i) {
    const Skeleton<WorldSpace> body = shifted(view.body, places[i].shift);
    auto fit = fit_outline({body, view.shape, view.world_from_sensor, view.camera, view.evidence},
                           outline);
    if (!fit || fit->inside < settings.least_inside || fit->mean_px > outline.lost_px) continue;
    fit->shift += places[i].shift;
    if (!best || fit->mean_px < best->mean_px) best = fit;
  }
  return best;
}

}  // namespace chorus::silhouette
