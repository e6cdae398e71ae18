// The configuration section device.positioner.
#pragma once

#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/positioning/method.h"
#include "services/sensor/device/positioner/picture_eye.h"
#include "services/sensor/device/suit/suit_settings.h"

namespace chorus::positioner {

struct PositionerCamera {
  std::string name;     ///< As the file of places calls it.
  std::string section;  ///< The keys of device.camera, as JSON.
};

struct PositionerSettings {
  std::string label = {};
  std::string places = {};  ///< A file in the form of registration.file.
  suit::SuitSettings suit{};
  std::vector<PositionerCamera> cameras{};
  /// Added to the suit's time to get the cameras' [s].
  double clock_offset_s = 0.0;
  double max_rate_hz = 60.0;
  positioning::Method method = positioning::Method::Both;
  EyeBackground background = EyeBackground::Auto;
  double girth = 1.0;  ///< Of the person, relative to a usual one.
};

/// Reads the section; the reader's finish() reports mistakes.
[[nodiscard]] PositionerSettings read_positioner_settings(ConfigReader& section);

}  // namespace chorus::positioner
