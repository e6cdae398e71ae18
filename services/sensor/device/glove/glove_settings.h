// The configuration section device.glove.
#pragma once

#include <string>

#include "common/base/config_reader.h"
#include "services/sensor/device/camera/camera_settings.h"

namespace chorus::glove {

/// What tells where the hand is in the picture.
enum class GloveFinding {
  Dark,    ///< The darkest region: a black glove on a brighter ground.
  Network  ///< The joints that the runner's hand network sees.
};

struct GloveSettings {
  std::string label = {};
  std::string hand = {};  ///< The .json that `chorus scan` wrote.
  std::string take = {};  ///< How the hand is held: a .bvh over that hand, which loops.
  GloveFinding find = GloveFinding::Dark;
  int darkest = 70;  ///< Pixels up to this grey level are glove.
  /// A file in the form of registration.file, and the camera's name in it; empty: the camera is
  /// level and looks along the take's +z.
  std::string places = {};
  std::string camera_name = {};
  double clock_offset_s = 0.0;      ///< Added to the take's time to get the camera's [s].
  camera::CameraSettings camera{};  ///< `runner` and `model` count for Network only.
};

/// Reads the section; the reader's finish() reports mistakes.
[[nodiscard]] GloveSettings read_glove_settings(ConfigReader& section);

}  // namespace chorus::glove
