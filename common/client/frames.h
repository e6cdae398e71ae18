// Following /frame: the bodies of a sensor, or the fused people of a tracker.
#pragma once

#include "common/client/document_kind.h"
#include "common/resource/frame_resource.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::client {

/// A frame in sensor space must be of the expected source.  A frame in world space may have any
/// source, because trackers can be chained.
extern const KindOf<resource::FrameResource> kFrames;

/// The frame with its times corrected to our clock, and with the floor; the floor of a frame in
/// world space is y = 0 instead.
[[nodiscard]] SensorFrame place_in_time(const Arrived<resource::FrameResource>& arrived);

/// A document at `path` is of another source than expected.
[[nodiscard]] tl::unexpected<Error> not_called(std::string path, const std::string& source,
                                               const SensorId& expected);

}  // namespace chorus::client
