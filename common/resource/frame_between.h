// Interpolates a frame for an instant that has none.
#pragma once

#include "common/resource/frame_resource.h"

namespace chorus::resource {

/// The frame at `instant` between two neighbours, a.captured <= instant <= b.captured: positions
/// linear (ray directions normalised), orientations by LERP, the worse state, the larger variance,
/// the contributors of both.  Contains only the bodies and joints that are in both frames.
[[nodiscard]] FrameResource between(const FrameResource& a, const FrameResource& b,
                                    Timestamp instant);

}  // namespace chorus::resource
