// A snapshot as the resource /frame.
#pragma once

#include "common/resource/frame_resource.h"
#include "fusion-server/flow/snapshot.h"

namespace chorus::wire {

/// The `source` of a fusion server's /frame.
inline constexpr std::string_view kFusionSource = "fusion";

[[nodiscard]] resource::FrameResource to_resource(const Snapshot& snapshot);

}  // namespace chorus::wire
