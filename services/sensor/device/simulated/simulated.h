// The device `simulated`: people made from real motion capture, seen by a sensor model of
// common/synthetic from a configured place.
//
// Where people are depends only on true UTC minus the scene's epoch.  So processes that share the
// `scene` keys see the same people at the same instant, whatever their own clocks say.  The keys
// are in simulated_settings.h and scene_settings.h.
#pragma once

#include <memory>

#include "common/base/config_reader.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/device/host_time.h"

namespace chorus::sensor_service {

/// Makes the device; the reader's finish() reports mistakes.  The sensor's errors depend on its id,
/// so that sensors with the same seed differ.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_simulated(ConfigReader& config,
                                                                  const SensorId& sensor,
                                                                  const HostTime& time);

}  // namespace chorus::sensor_service
