#include "common/record/floor_message.h"

#include <array>

#include <nlohmann/json.hpp>

#include "common/base/json.h"

namespace chorus::record {
namespace {

constexpr std::array<const char*, 4> kKeys{"normalX", "normalY", "normalZ", "offset"};

}  // namespace

std::string floor_json(const FloorPlane& floor) {
  const std::array values{floor.normal.x(), floor.normal.y(), floor.normal.z(), floor.offset};
  nlohmann::json json;
  for (std::size_t i = 0; i < kKeys.size(); ++i) json[kKeys[i]] = values[i];
  return json.dump();
}

Result<FloorPlane> read_floor_json(std::string_view text) {
  const auto json = parse_json(text).value_or(nlohmann::json());
  std::array<double, 4> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!json.is_object() || !json.contains(kKeys[i]) || !json[kKeys[i]].is_number()) {
      return fail(ErrorCode::Malformed, "floor-plane", "a floor plane is not four numbers");
    }
    v[i] = json[kKeys[i]].get<double>();
  }
  return make_plane(v[0], v[1], v[2], v[3]);
}

}  // namespace chorus::record
