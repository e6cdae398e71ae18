#include "services/sensor/device/glove/glove_settings.h"

namespace chorus::glove {

GloveSettings read_glove_settings(ConfigReader& section) {
  GloveSettings settings;
  section.read("label", settings.label);
  section.read("hand", settings.hand);
  section.read("take", settings.take);
  std::size_t find = 0;
  section.read_choice("find", find, {"dark", "network"});
  settings.find = static_cast<GloveFinding>(find);
  section.read("darkest", settings.darkest, 1, 254);
  section.read("places", settings.places);
  section.read("camera_name", settings.camera_name);
  section.read("clock_offset_s", settings.clock_offset_s, -60.0, 60.0);
  ConfigReader camera = section.child("camera");
  settings.camera = camera::read_camera_settings(camera);
  if (!camera.has("model")) settings.camera.model = "hands";
  return settings;
}

}  // namespace chorus::glove
