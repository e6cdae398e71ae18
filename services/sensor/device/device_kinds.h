// The kinds of devices, one row each, and the configuration section "device".
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
  http::Router& router;  ///< A device adds its own resources here while it is being made.
};

struct DeviceKind {
  std::string_view name;  ///< The value of device.kind, and the NAME of the section device.NAME.
  /// Reports every mistake in the section, even if another kind is selected: a file may have
  /// sections for all kinds.
  void (*read)(ConfigReader& section, const SensorId& sensor);
  /// Makes the device, ready to run.
  Result<std::unique_ptr<FrameSource>> (*make)(ConfigReader& section, const DeviceContext& context);
};

/// All kinds; the first one is the default.
[[nodiscard]] std::span<const DeviceKind> device_kinds();

/// The selected device.  Two choices are equal when kind and settings are.
struct DeviceChoice {
  std::string kind;
  std::string section;  ///< JSON, with the assignments from the command line.

  bool operator==(const DeviceChoice&) const = default;
};

/// Reads the section "device"; the reader's finish() reports mistakes.
void read_device(ConfigReader config, const SensorId& sensor, DeviceChoice& out);

/// Makes the selected device.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_device(const DeviceChoice& choice,
                                                               const DeviceContext& context);

}  // namespace chorus::sensor_service
