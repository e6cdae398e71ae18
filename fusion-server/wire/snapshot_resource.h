// A snapshot as the resource /frame.
#pragma once

#include "common/resource/frame_resource.h"
#include "fusion-server/flow.h"

namespace chorus::wire {

/// What /frame of a fusion server says in `source`.
inline constexpr std::string_view kFusionSource = "fusion";

[[nodiscard]] resource::FrameResource to_resource(const Snapshot& snapshot);

/// The frame at `instant` between two neighbours, a.captured <= instant <= b.captured: positions
/// linear, orientations by LERP, the worse state, the larger variance, contributors of both.  Only
/// bodies and joints that both have.
[[nodiscard]] resource::FrameResource between(const resource::FrameResource& a,
                                              const resource::FrameResource& b, Timestamp instant);

}  // namespace chorus::wire
