// `/floor-plane`: unit normal n and offset d [m] with n.x + d = 0, in the service's own space.
#pragma once

#include <string_view>

#include "common/resource/frame_resource.h"
#include "common/resource/node.h"

namespace chorus::resource {

[[nodiscard]] Node floor_plane_node(const FloorPlane& floor, SpaceKind space);

/// Normalises the normal; refuses a zero one, missing numbers, and offsets beyond kMaxCoordinate.
[[nodiscard]] Result<FloorPlane> read_floor_plane(std::string_view bytes, Format format);

}  // namespace chorus::resource
