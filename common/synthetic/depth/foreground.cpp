#include "common/synthetic/depth/foreground.h"

#include <array>
#include <cmath>
#include <limits>

namespace chorus::synthetic::depth {
namespace {

constexpr double kFloorBand = 0.05;  // Everything lower counts as floor [m].
constexpr double kHighest = 2.4;     // Nobody reaches higher [m].
// Largest difference of depth between neighbouring pixels of one surface [m].
constexpr double kJoined = 0.10;
// A pixel is stray if fewer of its eight neighbours than this are on its surface.
constexpr int kLeastNeighbours = 3;
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

constexpr std::array<std::array<int, 2>, 8> kAround{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/// Index of the neighbouring pixel; kNone if it is outside the image.
std::size_t beside(const DepthImage& image, std::size_t index, const std::array<int, 2>& step) {
  const int column = static_cast<int>(index) % image.width + step[0];
  const int row = static_cast<int>(index) / image.width + step[1];
  if (column < 0 || row < 0 || column >= image.width || row >= image.height) return kNone;
  return image.index(column, row);
}

bool is_joined(const DepthImage& image, std::size_t a, std::size_t b) {
  return b != kNone && image.depth[b] > 0 &&
         std::abs(static_cast<double>(image.depth[a] - image.depth[b])) < kJoined;
}

bool is_stray(const DepthImage& image, std::size_t index) {
  int like = 0;
  for (const auto& step : kAround) like += is_joined(image, index, beside(image, index, step));
  return like < kLeastNeighbours;
}

/// For each pixel the index of its point, or kNone.
using PointOfPixel = std::vector<std::size_t>;

PointOfPixel pick(const DepthImage& image, const DepthCamera& camera, const Plane& floor,
                  std::vector<SurfacePoint>& points) {
  PointOfPixel point_of(image.depth.size(), kNone);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const std::size_t i = image.index(column, row);
      if (!(image.depth[i] > 0)) continue;
      SurfacePoint point;
      point.position = image.at(column, row) * camera.ray(column, row);
      point.above_floor = floor.normal.dot(point.position) + floor.offset;
      if (point.above_floor < kFloorBand || point.above_floor > kHighest) continue;
      if (is_stray(image, i)) continue;
      point.piece = kNone;
      point_of[i] = points.size();
      points.push_back(point);
    }
  }
  return point_of;
}

void flood(const DepthImage& image, const PointOfPixel& point_of, std::size_t start,
           std::size_t piece, std::vector<SurfacePoint>& points) {
  std::vector<std::size_t> open{start};
  points[point_of[start]].piece = piece;
  while (!open.empty()) {
    const std::size_t pixel = open.back();
    open.pop_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = beside(image, pixel, kAround[k]);
      if (!is_joined(image, pixel, next) || point_of[next] == kNone) continue;
      SurfacePoint& point = points[point_of[next]];
      if (point.piece != kNone) continue;
      point.piece = piece;
      open.push_back(next);
    }
  }
}

}  // namespace

Foreground foreground_of(const DepthImage& image, const DepthCamera& camera, const Plane& floor) {
  Foreground found;
  const PointOfPixel point_of = pick(image, camera, floor, found.points);
  for (std::size_t pixel = 0; pixel < point_of.size(); ++pixel) {
    if (point_of[pixel] == kNone || found.points[point_of[pixel]].piece != kNone) continue;
    flood(image, point_of, pixel, found.pieces++, found.points);
  }
  return found;
}

}  // namespace chorus::synthetic::depth
