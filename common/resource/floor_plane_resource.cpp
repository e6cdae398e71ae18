#include "common/resource/floor_plane_resource.h"

#include <array>
#include <cmath>

#include "common/resource/flat_reader.h"
#include "common/resource/frame_parts.h"

namespace chorus::resource {

Node floor_plane_node(const FloorPlane& floor, SpaceKind space) {
  constexpr int kDigits = 6;  // Number of decimals: an angle of 1e-6 rad is 0.001 mm at 1 m.
  return {"",
          {"FloorPlane"},
          {{"normalX", Decimal{floor.normal.x(), kDigits}},
           {"normalY", Decimal{floor.normal.y(), kDigits}},
           {"normalZ", Decimal{floor.normal.z(), kDigits}},
           {"offset", Decimal{floor.offset, kDigits}},
           {"space", std::string(name_of(space))}}};
}

Result<FloorPlane> read_floor_plane(std::string_view bytes, Format format) {
  const auto properties = read_properties(bytes, format, "FloorPlane");
  if (!properties) return pass(properties);
  constexpr std::array<std::string_view, 4> kKeys{"normalX", "normalY", "normalZ", "offset"};
  std::array<double, 4> plane{};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const auto value = number_of(*properties, kKeys[i]);
    if (!value) return pass(value);
    if (std::abs(*value) > kMaxCoordinate) {
      return fail(ErrorCode::Malformed, "ch:" + std::string(kKeys[i]),
                  "is beyond anything a floor can be");
    }
    plane[i] = *value;
  }
  return make_plane(plane[0], plane[1], plane[2], plane[3]);
}

}  // namespace chorus::resource
