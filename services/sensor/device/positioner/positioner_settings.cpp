#include "services/sensor/device/positioner/positioner_settings.h"

#include "services/sensor/device/camera/camera_settings.h"

namespace chorus::positioner {

PositionerSettings read_positioner_settings(ConfigReader& section) {
  PositionerSettings settings;
  section.read("label", settings.label);
  section.read("places", settings.places);
  section.read("clock_offset_s", settings.clock_offset_s, -60.0, 60.0);
  section.read("max_rate_hz", settings.max_rate_hz, 1.0, 240.0);
  std::size_t method = 0;
  section.read_choice("method", method, {"both", "landmarks", "outline", "silhouettes", "suit"});
  settings.method = *positioning::method_named(positioning::method_names()[method]);
  std::size_t background = 0;
  section.read_choice("background", background, {"auto", "network", "mixtures"});
  settings.background = static_cast<EyeBackground>(background);
  section.read("girth", settings.girth, 0.5, 2.0);
  ConfigReader worn = section.child("worn");
  settings.suit = suit::read_suit_settings(worn);
  for (ConfigReader& camera : section.items("cameras")) {
    PositionerCamera one;
    camera.read("name", one.name);
    ConfigReader looks = camera.child("camera");
    (void)camera::read_camera_settings(looks);
    one.section = camera.text("camera");
    settings.cameras.push_back(std::move(one));
  }
  return settings;
}

}  // namespace chorus::positioner
