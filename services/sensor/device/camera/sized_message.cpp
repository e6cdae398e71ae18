#include "services/sensor/device/camera/sized_message.h"

#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/sensor/pixel_ray.h"
#include "services/sensor/device/bridge/json_value.h"
#include "services/sensor/device/camera/apparent_size.h"

namespace chorus::camera {
namespace {

using bridge::At;
using Json = nlohmann::json;

constexpr JsonLimits kLimits{.bytes = 2'000'000, .nesting = 8};
constexpr bridge::Bounds kMetres{-10.0, 10.0};

/// Reads a landmark from [u, v, confidence] and [x, y, z]; one that is not used has weight zero.
Result<SizedLandmark> read_landmark(const Json& pixel, const Json& shape,
                                    const bridge::Hello& hello, const At& at) {
  SizedLandmark out;
  if (shape.is_null()) return out;
  std::array<double, 3> metres{};
  if (const auto ok = bridge::read_numbers(shape, metres, kMetres, at); !ok) return pass(ok);
  const bool plain = pixel.is_array() && pixel.size() >= 2 && pixel[0].is_number() &&
                     pixel[1].is_number() && (pixel.size() == 2 || pixel[2].is_number());
  if (!plain) return out;
  const auto ray = ray_of({pixel[0].get<double>(), pixel[1].get<double>()}, *hello.camera);
  if (!ray) return out;
  out.ray = *ray;
  out.shape = {metres[0], metres[1], metres[2]};
  out.weight = pixel.size() > 2 ? pixel[2].get<double>() : 1.0;
  out.ray_covariance = ray_covariance(*ray, *hello.camera, *hello.pixel_sigma);
  return out;
}

Result<std::vector<SizedLandmark>> read_landmarks(const Json& pixels, const Json& world,
                                                  const bridge::Hello& hello, const At& at) {
  const std::size_t count = hello.layout->landmarks.size();
  if (!world.is_array() || world.size() != count || pixels.size() != count) {
    return bridge::wrong(
        at, fmt::format("must be an array of {} places [m], as many as \"pixels\"", count));
  }
  std::vector<SizedLandmark> landmarks;
  for (std::size_t i = 0; i < count; ++i) {
    auto landmark = read_landmark(pixels[i], world[i], hello, at[i]);
    if (!landmark) return pass(landmark);
    landmarks.push_back(*landmark);
  }
  return landmarks;
}

Json point_json(const SizedLandmark& landmark, const PlacedLandmark& placed,
                const Eigen::Matrix3d& hello_from_camera) {
  if (landmark.weight <= 0.0) return nullptr;
  const Eigen::Vector3d at = hello_from_camera * placed.position;
  const Covariance covariance = Covariance(placed.covariance).turned(hello_from_camera);
  Json upper = Json::array();
  for (std::size_t i = 0; i < Covariance::kTerms; ++i) upper.push_back(covariance.term(i));
  return {{"at", {at.x(), at.y(), at.z()}},
          {"confidence", landmark.weight},
          {"covariance", std::move(upper)}};
}

Result<void> place_body(Json& body, const bridge::Hello& hello, const At& at) {
  if (!body.is_object() || !body.contains("world") || !body.contains("pixels")) return {};
  if (!body["pixels"].is_array()) return {};
  const auto landmarks = read_landmarks(body["pixels"], body["world"], hello, at["world"]);
  if (!landmarks) return pass(landmarks);
  const auto placed = placed_by_size(*landmarks);
  if (!placed) return {};
  const Eigen::Matrix3d sensor_from_camera = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  const Eigen::Matrix3d turn = hello.sensor_from_pusher.transpose() * sensor_from_camera;
  Json points = Json::array();
  for (std::size_t i = 0; i < placed->size(); ++i)
    points.push_back(point_json((*landmarks)[i], (*placed)[i], turn));
  body["points"] = std::move(points);
  body.erase("pixels");
  return {};
}

}  // namespace

Result<std::string> points_by_size(std::string_view line, const bridge::Hello& hello) {
  auto message = parse_json(line, kLimits);
  if (!message) return pass(message);
  const bool has_bodies = message->is_object() && message->contains("bodies");
  if (!has_bodies || !(*message)["bodies"].is_array()) return std::string(line);
  const At at = At{}["bodies"];
  Json& bodies = (*message)["bodies"];
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (const auto ok = place_body(bodies[i], hello, at[i]); !ok) return pass(ok);
  }
  return message->dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace chorus::camera
