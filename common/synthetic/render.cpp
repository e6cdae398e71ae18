#include "common/synthetic/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "common/synthetic/body_shape.h"
#include "common/synthetic/picture.h"

namespace chorus::synthetic {
namespace {

constexpr std::uint64_t kDrawDepth = 401;
constexpr double kMaxDepthCode = 65535;  // Largest 16-bit value.
constexpr double kTileSize = 0.5;        // Of the floor pattern [m].
constexpr std::uint16_t kNobody = 0;
constexpr std::uint16_t kThing = 65535;
constexpr int kMaxPixels = 4'000'000;

/// What each pixel sees: the distance along its ray, and whose body that is (the person's index +
/// 1; kNobody: the floor or nothing; kThing: an occluder).
struct RangeImage {
  int width = 0;
  int height = 0;
  std::vector<float> range;  ///< [m]; infinity: nothing
  std::vector<std::uint16_t> person;
  std::vector<Eigen::Vector3f> rays;  ///< Unit vectors.
};

/// The ray of a pixel.  Sensor x points to the sensor's left, but image columns run to its right.
Eigen::Vector3d ray_of(const Intrinsics& camera, int column, int row) {
  return Eigen::Vector3d(-(column - camera.cx) / camera.fx, -(row - camera.cy) / camera.fy, 1)
      .normalized();
}

struct Box {
  int left, right, top, bottom;  ///< In pixels; right and bottom are exclusive.
};

/// The pixels that may see the capsule: a rectangle around its two end balls, or all pixels when
/// the capsule is too near.
Box box_of(const Capsule& capsule, const Intrinsics& camera) {
  Box box{camera.width, 0, camera.height, 0};
  for (const Eigen::Vector3d& end : {capsule.from, capsule.to}) {
    const double depth = end.z() - capsule.radius;
    if (depth < capsule.radius) return {0, camera.width, 0, camera.height};
    const double reach = 2 + capsule.radius * std::max(camera.fx, camera.fy) / depth *
                                 (1 + end.head<2>().norm() / depth);
    const double column = camera.cx - camera.fx * end.x() / end.z();
    const double row = camera.cy - camera.fy * end.y() / end.z();
    const auto clip = [](double v, int most) {
      return static_cast<int>(std::clamp(v, 0.0, double(most)));
    };
    box.left = std::min(box.left, clip(column - reach, camera.width));
    box.right = std::max(box.right, clip(column + reach, camera.width));
    box.top = std::min(box.top, clip(row - reach, camera.height));
    box.bottom = std::max(box.bottom, clip(row + reach, camera.height));
  }
  return box;
}

void see_floor(RangeImage& image, const Plane& floor) {
  for (std::size_t i = 0; i < image.rays.size(); ++i) {
    const double down = floor.normal.dot(image.rays[i].cast<double>());
    if (down < 0) image.range[i] = static_cast<float>(-floor.offset / down);
  }
}

void see_capsule(RangeImage& image, const Capsule& capsule, const Intrinsics& camera,
                 std::uint16_t person) {
  const Box box = box_of(capsule, camera);
  for (int row = box.top; row < box.bottom; ++row) {
    for (int column = box.left; column < box.right; ++column) {
      const auto i = static_cast<std::size_t>(row * image.width + column);
      const auto distance = hit(capsule, image.rays[i].cast<double>());
      if (!distance || *distance >= static_cast<double>(image.range[i])) continue;
      image.range[i] = static_cast<float>(*distance);
      image.person[i] = person;
    }
  }
}

void see_box(RangeImage& image, const Eigen::Isometry3d& box_from_sensor,
             const Eigen::Vector3d& half) {
  for (std::size_t i = 0; i < image.rays.size(); ++i) {
    const auto distance = hit_box(half, box_from_sensor.translation(),
                                  box_from_sensor.linear() * image.rays[i].cast<double>());
    if (!distance || *distance >= static_cast<double>(image.range[i])) continue;
    image.range[i] = static_cast<float>(*distance);
    image.person[i] = kThing;
  }
}

/// An image with the ray of every pixel, none of which sees anything yet.
RangeImage open_eyes(const Intrinsics& camera) {
  const auto pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  RangeImage image{camera.width, camera.height,
                   std::vector<float>(pixels, std::numeric_limits<float>::infinity()),
                   std::vector<std::uint16_t>(pixels, kNobody),
                   std::vector<Eigen::Vector3f>(pixels)};
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      image.rays[static_cast<std::size_t>(row * camera.width + column)] =
          ray_of(camera, column, row).cast<float>();
    }
  }
  return image;
}

Result<RangeImage> look(const Scene& scene, std::size_t sensor, Timestamp instant,
                        const Intrinsics& camera) {
  if (sensor >= scene.world_from_sensor.size() || camera.width <= 0 || camera.height <= 0 ||
      camera.width > kMaxPixels / camera.height || !(camera.fx > 0) || !(camera.fy > 0)) {
    return fail(ErrorCode::InvalidArgument, "render", "there is no such sensor or no such camera");
  }
  RangeImage image = open_eyes(camera);
  const Eigen::Isometry3d sensor_from_world = scene.world_from_sensor[sensor].inverse();
  see_floor(image, floor_in_sensor(scene.world_from_sensor[sensor]));
  for (std::size_t person = 0; person < scene.people.size(); ++person) {
    const auto body = to_sensor(sensor_from_world, truth(scene, person, instant));
    for (const Capsule& capsule : capsules_of(body)) {
      see_capsule(image, capsule, camera, static_cast<std::uint16_t>(person + 1));
    }
  }
  for (const Occluder& thing : scene.occluders) {
    const Eigen::Isometry3d world_from_box = place_of(thing, instant - scene.epoch);
    see_box(image, world_from_box.inverse() * scene.world_from_sensor[sensor], thing.half);
  }
  return image;
}

/// The colour (red, green, blue) of what pixel `i` sees: a person, a thing or the chequered floor;
/// a grey wall where it sees nothing.
std::array<std::uint8_t, 3> shade(const RangeImage& image, std::size_t i,
                                  const Eigen::Isometry3d& world_from_sensor) {
  const double range = static_cast<double>(image.range[i]);
  if (!std::isfinite(range)) return {184, 190, 196};
  const double light = std::clamp(1.15 - 0.13 * range, 0.35, 1.0);
  Eigen::Vector3d colour(210, 120, 96);
  if (image.person[i] == kNobody) {
    const Eigen::Vector3d x = world_from_sensor * (range * image.rays[i].cast<double>());
    const double tile = std::floor(x.x() / kTileSize) + std::floor(x.z() / kTileSize);
    colour = std::fmod(std::abs(tile), 2.0) < 0.5 ? Eigen::Vector3d(165, 160, 150)
                                                  : Eigen::Vector3d(132, 128, 120);
  } else if (image.person[i] == kThing) {
    colour = Eigen::Vector3d(84, 78, 70);
  } else if (image.person[i] % 2 == 0) {
    colour = Eigen::Vector3d(90, 170, 110);
  }
  const Eigen::Vector3d lit = light * colour;
  return {static_cast<std::uint8_t>(lit.x()), static_cast<std::uint8_t>(lit.y()),
          static_cast<std::uint8_t>(lit.z())};
}

Result<CameraImage> image_of(const Result<std::string>& bytes, const char* media_type,
                             Timestamp instant, const Intrinsics& camera) {
  if (!bytes) return pass(bytes);
  return CameraImage{instant, camera, media_type, *bytes};
}

}  // namespace

Result<CameraImage> render_depth(const Scene& scene, std::size_t sensor, Timestamp instant,
                                 const CameraModel& camera) {
  const Result<RangeImage> image = look(scene, sensor, instant, camera.intrinsics);
  if (!image) return pass(image);
  Draw draw{camera.seed, kDrawDepth, sensor, static_cast<std::uint64_t>(to_unix_ns(instant))};
  std::vector<std::uint16_t> pixels(image->rays.size(), 0);
  for (std::size_t i = 0; i < image->rays.size(); ++i) {
    const double exact =
        static_cast<double>(image->range[i]) * static_cast<double>(image->rays[i].z());
    if (!(exact <= camera.most_depth)) continue;
    const double measured = std::round(to_mm(exact + camera.depth_noise * draw.gauss()));
    pixels[i] = static_cast<std::uint16_t>(std::clamp(measured, 0.0, kMaxDepthCode));
  }
  return image_of(png_of(pixels, {image->width, image->height}), "image/png", instant,
                  camera.intrinsics);
}

Result<CameraImage> render_color(const Scene& scene, std::size_t sensor, Timestamp instant,
                                 const CameraModel& camera) {
  const Result<RangeImage> image = look(scene, sensor, instant, camera.intrinsics);
  if (!image) return pass(image);
  std::vector<std::uint8_t> pixels;
  pixels.reserve(3 * image->rays.size());
  for (std::size_t i = 0; i < image->rays.size(); ++i) {
    const auto colour = shade(*image, i, scene.world_from_sensor[sensor]);
    pixels.insert(pixels.end(), colour.begin(), colour.end());
  }
  return image_of(jpeg_of(pixels, {image->width, image->height}), "image/jpeg", instant,
                  camera.intrinsics);
}

}  // namespace chorus::synthetic
