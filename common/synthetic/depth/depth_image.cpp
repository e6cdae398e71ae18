#include "common/synthetic/depth/depth_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace chorus::synthetic::depth {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
// Neighbouring pixels whose depths differ by more than this form an edge [m].
constexpr double kEdge = 0.10;

struct Patch {
  int left, right, top, bottom;  ///< Pixels, right and bottom exclusive.
};

/// The pixels that may see the taper: a rectangle around the balls at its ends, or the whole image
/// if the taper is too near.
Patch patch_of(const Taper& taper, const DepthCamera& camera) {
  Patch patch{camera.width, 0, camera.height, 0};
  const auto clip = [](double v, int most) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most)));
  };
  for (const auto& [end, radius] :
       {std::pair{taper.from, taper.radius_from}, std::pair{taper.to, taper.radius_to}}) {
    const double nearest = end.z() - radius;
    if (nearest < radius) return {0, camera.width, 0, camera.height};
    const double reach = 2 + radius * camera.focal / nearest * (1 + end.head<2>().norm() / nearest);
    const double column = camera.cx - camera.focal * end.x() / end.z();
    const double row = camera.cy - camera.focal * end.y() / end.z();
    patch.left = std::min(patch.left, clip(column - reach, camera.width));
    patch.right = std::max(patch.right, clip(column + reach, camera.width));
    patch.top = std::min(patch.top, clip(row - reach, camera.height));
    patch.bottom = std::max(patch.bottom, clip(row + reach, camera.height));
  }
  return patch;
}

/// Calls each(index, unit ray, z of the unit ray) over the patch.
template <class Each>
void over(const Patch& patch, const DepthCamera& camera, const DepthImage& image, Each each) {
  for (int row = patch.top; row < patch.bottom; ++row) {
    for (int column = patch.left; column < patch.right; ++column) {
      const Eigen::Vector3d ray = camera.ray(column, row);
      const double z = 1.0 / ray.norm();
      each(image.index(column, row), Eigen::Vector3d(z * ray), z);
    }
  }
}

void draw_box(DepthImage& image, const kinect::Box& box, const DepthCamera& camera) {
  over({0, camera.width, 0, camera.height}, camera, image,
       [&](std::size_t i, const Eigen::Vector3d& ray, double z) {
         const auto distance = hit(box, ray);
         if (!distance) return;
         const auto depth = static_cast<float>(*distance * z);
         if (depth < image.depth[i]) image.depth[i] = depth;
       });
}

void draw_taper(DepthImage& image, const Taper& taper, const DepthCamera& camera) {
  over(patch_of(taper, camera), camera, image,
       [&](std::size_t i, const Eigen::Vector3d& ray, double z) {
         const auto distance = hit(taper, ray);
         if (!distance) return;
         const auto depth = static_cast<float>(*distance * z);
         if (depth >= image.depth[i]) return;
         image.depth[i] = depth;
         image.dark[i] = taper.dark;
       });
}

/// Nearly Gaussian noise of unit variance from one draw: the sum of four uniform numbers, within
/// +-3.5.
double unit_noise(Draw& draw) {
  const std::uint64_t bits = draw.bits();
  double sum = 0;
  for (int part = 0; part < 4; ++part) {
    sum += static_cast<double>((bits >> (16 * part)) & 0xffffu);
  }
  constexpr double kMean = 4 * 32767.5;
  constexpr double kScale = 1.7320508075688772 / 65536.0;  // Four numbers, each of variance 1/12.
  return (sum - kMean) * kScale;
}

/// The depth of a neighbouring pixel beyond an edge; the pixel's own depth if there is no edge.
double across_edge(const DepthImage& exact, int column, int row) {
  const double own = exact.at(column, row);
  constexpr std::array<std::array<int, 2>, 4> kCross{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  for (const auto& [dx, dy] : kCross) {
    const int x = column + dx;
    const int y = row + dy;
    if (x < 0 || y < 0 || x >= exact.width || y >= exact.height) continue;
    const double other = exact.at(x, y);
    if (std::isfinite(other) && std::abs(other - own) > kEdge) return other;
  }
  return own;
}

}  // namespace

bool DepthCamera::see(const Eigen::Vector3d& point, int& column, int& row) const {
  if (!(point.z() > 0)) return false;
  const double x = std::round(cx - focal * point.x() / point.z());
  const double y = std::round(cy - focal * point.y() / point.z());
  if (!(x >= 0 && y >= 0 && x < width && y < height)) return false;
  column = static_cast<int>(x);
  row = static_cast<int>(y);
  return true;
}

std::optional<double> hit(const kinect::Box& box, const Eigen::Vector3d& ray) {
  const Eigen::Isometry3d box_from_sensor = box.sensor_from_box.inverse();
  const Eigen::Vector3d eye = box_from_sensor.translation();
  const Eigen::Vector3d along = box_from_sensor.linear() * ray;
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(along[axis]) < 1e-12) {
      if (std::abs(eye[axis]) > box.half[axis]) return std::nullopt;
      continue;
    }
    const double a = (-box.half[axis] - eye[axis]) / along[axis];
    const double b = (box.half[axis] - eye[axis]) / along[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave && enter > 0 ? std::optional(enter) : std::nullopt;
}

DepthImage render(const View& view, const DepthCamera& camera) {
  const auto pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  DepthImage image{camera.width, camera.height, std::vector<float>(pixels, kNothing),
                   std::vector<bool>(pixels, false)};
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const double down = view.floor.normal.dot(camera.ray(column, row));
      if (down < 0) {
        image.depth[image.index(column, row)] = static_cast<float>(-view.floor.offset / down);
      }
    }
  }
  for (const kinect::Box& box : view.boxes) draw_box(image, box, camera);
  for (const Taper& taper : view.people) draw_taper(image, taper, camera);
  return image;
}

DepthImage measure(const DepthImage& exact, const TimeOfFlight& camera, Draw draw) {
  DepthImage image{exact.width, exact.height, std::vector<float>(exact.depth.size(), 0.0f), {}};
  for (int row = 0; row < exact.height; ++row) {
    for (int column = 0; column < exact.width; ++column) {
      const std::size_t i = exact.index(column, row);
      double depth = exact.at(column, row);
      if (!std::isfinite(depth)) continue;
      const double lost = exact.dark[i] ? camera.dark_hole_share : camera.hole_share;
      if (draw.uniform() < lost) continue;
      const double other = across_edge(exact, column, row);
      if (other != depth && draw.uniform() < camera.flying_share) {
        depth += draw.uniform() * (other - depth);
      }
      depth += (camera.noise_near + camera.noise_square * depth * depth) * unit_noise(draw);
      if (depth < camera.least_range || depth > camera.most_range) continue;
      image.depth[i] = static_cast<float>(depth);
    }
  }
  return image;
}

}  // namespace chorus::synthetic::depth
