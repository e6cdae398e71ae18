// The device `simulated`: people made from real motion capture, as a sensor model of
// common/synthetic sees them from a configured place.
//
// Where people are depends on true UTC alone (minus the scene's epoch), so processes that share the
// `scene` keys see the same people at the same instant, whatever their own clocks say.  The keys
// are in simulated_settings.h and scene_settings.h.
#pragma once

#include <memory>

#include "common/base/config_reader.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/device/host_time.h"

namespace chorus::sensor_service {

/// The reader's finish() reports mistakes.  The sensor's errors depend on its id, so that sensors
/// with one seed differ.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_simulated(ConfigReader& config,
                                                                  const SensorId& sensor,
                                                                  const HostTime& time);

}  // namespace chorus::sensor_service
