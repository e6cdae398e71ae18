#include "services/sensor/device/bridge/hello.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/sensor/impossible_lens.h"
#include "common/sensor/limits.h"
#include "services/sensor/device/bridge/json_value.h"

namespace chorus::bridge {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kVersion = 1;
constexpr std::size_t kMaxName = 64;
constexpr Bounds kShare{0.0, 1.0};
// No camera that sees people hangs this high [m].  A height of 1.6 m in millimetres or centimetres
// is above this limit.
constexpr double kHighest = 100.0;
// y of a floor's normal: a camera on the ceiling may look beyond straight down.
constexpr double kLeastUp = -0.5;

struct Direction {
  std::string_view word;
  Eigen::Vector3d in_sensor;  ///< Its direction: x to the sensor's left, y up, z ahead.
};

std::optional<Eigen::Vector3d> direction_of(std::string_view word) {
  static const std::array<Direction, 6> kDirections{{{"left", Eigen::Vector3d::UnitX()},
                                                     {"right", -Eigen::Vector3d::UnitX()},
                                                     {"up", Eigen::Vector3d::UnitY()},
                                                     {"down", -Eigen::Vector3d::UnitY()},
                                                     {"ahead", Eigen::Vector3d::UnitZ()},
                                                     {"back", -Eigen::Vector3d::UnitZ()}}};
  for (const Direction& direction : kDirections) {
    if (direction.word == word) return direction.in_sensor;
  }
  return std::nullopt;
}

bool is_name(const std::string& text) {
  const auto is_printable = [](char c) { return c >= ' ' && c <= '~'; };
  return !text.empty() && text.size() <= kMaxName &&
         std::all_of(text.begin(), text.end(), is_printable);
}

/// The string for a key; `otherwise` when the key is absent.
Result<std::string> text_at(const Json& message, const char* key, const char* otherwise) {
  const Json* value = find(message, key);
  if (value == nullptr) return std::string(otherwise);
  if (!value->is_string()) return wrong(At{}[key], "must be a string");
  return value->get<std::string>();
}

/// Reads a number; leaves `out` unchanged when the key is absent.
Result<void> number_at(const Json& object, const char* key, Bounds bounds, const At& at,
                       double& out) {
  const Json* value = find(object, key);
  if (value == nullptr) return {};
  return read_number(*value, bounds, at[key]).map([&](double number) { out = number; });
}

Result<void> needed_at(const Json& object, const char* key, Bounds bounds, const At& at,
                       double& out) {
  if (find(object, key) == nullptr) return wrong(at[key], "is missing");
  return number_at(object, key, bounds, at, out);
}

Result<Intrinsics> read_intrinsics(const Json& value) {
  const At at = At{}["intrinsics"];
  if (!value.is_object())
    return wrong(at, "must be an object with width, height, fx, fy, cx, cy [px]");
  Intrinsics camera;
  double width = 0.0;
  double height = 0.0;
  const Bounds size{1.0, kMaxPixels};
  const Bounds place{-kMaxPixels, kMaxPixels};
  for (const auto& ok :
       {needed_at(value, "width", size, at, width), needed_at(value, "height", size, at, height),
        needed_at(value, "fx", size, at, camera.fx), needed_at(value, "fy", size, at, camera.fy),
        needed_at(value, "cx", place, at, camera.cx),
        needed_at(value, "cy", place, at, camera.cy)}) {
    if (!ok) return pass(ok);
  }
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
  if (const Json* distortion = find(value, "distortion")) {
    const auto ok = read_numbers(*distortion, camera.distortion, {-100.0, 100.0}, at["distortion"]);
    if (!ok) return pass(ok);
  }
  if (const Json* model = find(value, "model")) {
    if (*model != "brown" && *model != "fisheye")
      return wrong(at["model"], "must be \"brown\" or \"fisheye\"");
    if (*model == "fisheye") camera.model = LensModel::Fisheye;
  }
  if (const auto objection = objection_to(camera))
    return wrong(at[objection->key], objection->text);
  return camera;
}

/// Reads all members that are numbers or consist of numbers.
Result<void> read_measures(const Json& message, Hello& hello) {
  hello.tracked_from = hello.layout->tracked_from;
  hello.inferred_from = hello.layout->inferred_from;
  double sigma = 0.0;
  for (const auto& ok : {number_at(message, "trackedFrom", kShare, {}, hello.tracked_from),
                         number_at(message, "inferredFrom", kShare, {}, hello.inferred_from),
                         number_at(message, "focalSigma", kShare, {}, hello.focal_sigma),
                         number_at(message, "pixelSigma", {0.01, 1000.0}, {}, sigma)}) {
    if (!ok) return ok;
  }
  if (sigma > 0.0) hello.pixel_sigma = sigma;
  if (const Json* intrinsics = find(message, "intrinsics")) {
    auto camera = read_intrinsics(*intrinsics);
    if (!camera) return pass(camera);
    hello.camera = *camera;
  }
  if (const Json* floor = find(message, "floor")) {
    auto plane = read_floor(*floor, hello.sensor_from_pusher);
    if (!plane) return pass(plane);
    hello.floor = *plane;
  }
  return {};
}

}  // namespace

Result<Eigen::Matrix3d> read_axes(std::string_view words) {
  Eigen::Matrix3d sensor_from_pusher;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t space = axis < 2 ? words.find(' ') : words.size();
    const auto direction = direction_of(words.substr(0, space));
    if (!direction || space == std::string_view::npos) {
      return wrong(
          At{}["axes"],
          "must say where x, y and z point as the camera sees it, in words of left, right, "
          "up, down, ahead, back: \"right down ahead\" (OpenCV), \"left up ahead\" "
          "(Kinect v2), \"right up back\" (OpenGL)");
    }
    sensor_from_pusher.col(axis) = *direction;
    words.remove_prefix(std::min(space + 1, words.size()));
  }
  if (std::abs(sensor_from_pusher.determinant()) > 0.5) return sensor_from_pusher;
  return wrong(At{}["axes"], "must name three directions at right angles");
}

Result<FloorPlane> read_floor(const Json& value, const Eigen::Matrix3d& sensor_from_pusher) {
  const At at = At{}["floor"];
  std::array<double, 4> numbers{};
  if (const auto ok = read_numbers(value, numbers, {-kMaxCoordinate, kMaxCoordinate}, at); !ok)
    return pass(ok);
  const auto& [x, y, z, offset] = numbers;
  const Eigen::Vector3d normal = sensor_from_pusher * Eigen::Vector3d(x, y, z);
  if (std::abs(offset) > kHighest) {
    return wrong(at[3],
                 fmt::format("is {:.0f}: that is how many metres the sensor is above the floor; is "
                             "it in millimetres?",
                             offset));
  }
  const auto plane = make_plane(normal.x(), normal.y(), normal.z(), offset);
  if (!plane || plane->normal.y() < kLeastUp || plane->offset < 0.0) {
    return wrong(at,
                 "must be [nx, ny, nz, d]: the floor's normal, pointing up, in your axes, and the "
                 "camera's height over the floor [m]");
  }
  return *plane;
}

Result<Hello> read_hello(const Json& message) {
  Hello hello;
  const Json* version = find(message, "version");
  if (version != nullptr && *version != kVersion)
    return fail(ErrorCode::Unsupported, "version", "this sensor speaks version 1");
  auto name = text_at(message, "name", "");
  if (!name) return pass(name);
  if (!is_name(*name)) {
    return wrong(At{}["name"], "say who you are, for people: 1 to 64 printable ASCII characters");
  }
  hello.name = std::move(*name);
  const auto layout_name = text_at(message, "layout", "");
  if (!layout_name) return pass(layout_name);
  const auto layout = layout::find_layout(*layout_name);
  if (!layout) return fail(ErrorCode::Malformed, "layout", layout.error().message);
  hello.layout = *layout;
  const auto axes = text_at(message, "axes", "left up ahead").and_then(read_axes);
  if (!axes) return pass(axes);
  hello.sensor_from_pusher = *axes;
  if (const auto ok = read_measures(message, hello); !ok) return pass(ok);
  return hello;
}

}  // namespace chorus::bridge
