// A snapshot as the resource /frame.
#pragma once

#include "common/resource/frame_resource.h"
#include "fusion-server/flow.h"

namespace chorus::wire {

/// What /frame of a fusion server says in `source`.
inline constexpr std::string_view kFusionSource = "fusion";

[[nodiscard]] resource::FrameResource to_resource(const Snapshot& snapshot);

}  // namespace chorus::wire
