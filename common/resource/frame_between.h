// An interpolated frame for an instant without one.
#pragma once

#include "common/resource/frame_resource.h"

namespace chorus::resource {

/// The frame at `instant` between two neighbours, a.captured <= instant <= b.captured: positions
/// linear (directions of rays normalised), orientations by LERP, the worse state, the larger
/// variance, contributors of both.  Only bodies and joints that both have.
[[nodiscard]] FrameResource between(const FrameResource& a, const FrameResource& b,
                                    Timestamp instant);

}  // namespace chorus::resource
