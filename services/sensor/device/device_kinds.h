// The kinds of devices there are, one row each: the section "device" of the configuration.
//
// A new kind is a folder beside this file and a row in device_kinds.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "common/base/config_reader.h"
#include "common/base/strong_id.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/device/host_time.h"

namespace chorus::sensor_service {

/// What a device is made with beside its own section.
struct DeviceContext {
  SensorId sensor;
  HostTime time;
};

struct DeviceKind {
  std::string_view name;  ///< device.kind, and the section device.NAME.
  /// Complains about every mistake in the section, also when another kind is chosen, so that a file
  /// may describe all of them.
  void (*read)(ConfigReader& section, const SensorId& sensor);
  /// The device, ready to run.
  Result<std::unique_ptr<FrameSource>> (*make)(ConfigReader& section, const DeviceContext& context);
};

/// The first is the default.
[[nodiscard]] std::span<const DeviceKind> device_kinds();

/// Which device is asked for.  Two are equal when the same kind is told the same.
struct DeviceChoice {
  std::string kind;
  std::string section;  ///< JSON, assignments of the command line included.

  bool operator==(const DeviceChoice&) const = default;
};

/// The section "device"; mistakes are reported by the reader's finish().
void read_device(ConfigReader config, const SensorId& sensor, DeviceChoice& out);

/// Only the kind that is chosen is made.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_device(const DeviceChoice& choice,
                                                               const DeviceContext& context);

}  // namespace chorus::sensor_service
