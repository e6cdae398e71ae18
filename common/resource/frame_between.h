// Interpolates a frame for an instant that has none.
#pragma once

#include "common/resource/frame_resource.h"

namespace chorus::resource {

/// The frame at `instant` between two neighbours, a.captured <= instant <= b.captured.  Positions
/// are interpolated linearly (ray directions are then normalised), orientations by LERP; states are
/// the worse of the two, variances the larger; contributors are those of both.  Contains only the
/// bodies and joints that are in both frames.  Returns `a` unchanged if the two state different
/// sensors.
[[nodiscard]] FrameResource between(const FrameResource& a, const FrameResource& b,
                                    Timestamp instant);

}  // namespace chorus::resource
