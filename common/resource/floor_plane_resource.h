// `/floor-plane`: unit normal n and offset d [m] with n.x + d = 0, in the space of the service.
#pragma once

#include <string_view>

#include "common/resource/frame_resource.h"
#include "common/resource/node.h"

namespace chorus::resource {

[[nodiscard]] Node floor_plane_node(const FloorPlane& floor, SpaceKind space);

/// Reads and normalises a floor plane; refuses a zero normal, missing numbers, and numbers beyond
/// kMaxCoordinate.
[[nodiscard]] Result<FloorPlane> read_floor_plane(std::string_view bytes, Format format);

}  // namespace chorus::resource
