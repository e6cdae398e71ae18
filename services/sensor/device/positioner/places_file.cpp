#include "services/sensor/device/positioner/places_file.h"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/geometry/rotation.h"

namespace chorus::positioner {
namespace {

constexpr JsonLimits kPlacesLimits{.bytes = 1 << 22, .nesting = 8};
constexpr double kFarthest = 1000.0;  // [m]

tl::unexpected<Error> wrong_place(const std::string& sensor, const std::string& why) {
  return fail(ErrorCode::Malformed, "places: " + sensor, why);
}

Result<Eigen::Isometry3d> place_in(const std::string& sensor, const nlohmann::json& entry) {
  constexpr std::array kKeys{"x", "y", "z", "qx", "qy", "qz", "qw"};
  std::array<double, kKeys.size()> numbers{};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const auto found = entry.is_object() ? entry.find(kKeys[i]) : entry.end();
    if (found == entry.end() || !found->is_number())
      return wrong_place(sensor, std::string("the number ") + kKeys[i] + " is missing");
    numbers[i] = found->get<double>();
    if (!(std::abs(numbers[i]) < kFarthest))
      return wrong_place(sensor, std::string(kKeys[i]) + " is not finite or absurdly large");
  }
  const Eigen::Quaterniond turn(numbers[6], numbers[3], numbers[4], numbers[5]);
  constexpr double kRounded = 0.01;
  if (!(std::abs(turn.norm() - 1.0) < kRounded))
    return wrong_place(sensor, "qx qy qz qw is no unit quaternion");
  return Eigen::Isometry3d(Eigen::Translation3d(numbers[0], numbers[1], numbers[2]) *
                           turn.normalized());
}

}  // namespace

Result<std::map<std::string, Eigen::Isometry3d>> read_places(std::string_view json) {
  const auto document = parse_json(json, kPlacesLimits);
  if (!document) return pass(document);
  const auto sensors = document->is_object() ? document->find("sensors") : document->end();
  if (sensors == document->end() || !sensors->is_object())
    return fail(ErrorCode::Malformed, "places",
                "\"sensors\" is missing, as `chorus calibrate place` writes it");
  std::map<std::string, Eigen::Isometry3d> out;
  for (const auto& [name, entry] : sensors->items()) {
    const auto place = place_in(name, entry);
    if (!place) return pass(place);
    out.emplace(name, *place);
  }
  return out;
}

}  // namespace chorus::positioner
