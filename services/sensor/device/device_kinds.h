// The kinds of devices, one row each: the section "device" of the configuration.
//
// A new kind is a folder next to this file and a row in device_kinds.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "common/base/config_reader.h"
#include "common/base/strong_id.h"
#include "common/http/router.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/device/host_time.h"

namespace chorus::sensor_service {

/// What a device needs in addition to its own section.
struct DeviceContext {
  SensorId sensor;
  HostTime time;
  http::Router& router;  ///< Here a device adds its own resources while it is being made.
};

struct DeviceKind {
  std::string_view name;  ///< device.kind, and the section device.NAME.
  /// Complains about every mistake in the section, even if another kind is selected, so that a file
  /// may describe all kinds.
  void (*read)(ConfigReader& section, const SensorId& sensor);
  /// Makes the device, ready to run.
  Result<std::unique_ptr<FrameSource>> (*make)(ConfigReader& section, const DeviceContext& context);
};

/// The first one is the default.
[[nodiscard]] std::span<const DeviceKind> device_kinds();

/// The selected device.  Choices are equal when kind and settings are.
struct DeviceChoice {
  std::string kind;
  std::string section;  ///< JSON, with the assignments from the command line.

  bool operator==(const DeviceChoice&) const = default;
};

/// The section "device"; mistakes are reported by the reader's finish().
void read_device(ConfigReader config, const SensorId& sensor, DeviceChoice& out);

/// Makes only the kind that is selected.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_device(const DeviceChoice& choice,
                                                               const DeviceContext& context);

}  // namespace chorus::sensor_service
