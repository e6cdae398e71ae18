#include "services/sensor/device/suit/suit_settings.h"

#include "common/client/follow_config.h"

namespace chorus::suit {

SuitSettings read_suit_settings(ConfigReader& section) {
  SuitSettings settings;
  section.read("file", settings.file);
  if (section.has("service")) {
    ConfigReader service = section.child("service");
    settings.service = client::read_followed(service, client::read_trust(section.child("service")));
    if (!settings.file.empty())
      section.complain("service", "cannot be used together with device.suit.file");
  }
  section.read("loop", settings.loop);
  section.read("label", settings.label);
  section.read("address", settings.address);
  section.read("port", settings.port, 0, 65535);
  std::size_t transport = 0;
  section.read_choice("transport", transport, {"udp", "tcp"});
  settings.transport = transport == 0 ? Transport::Udp : Transport::Tcp;
  section.read("character", settings.character, 0, 255);
  section.read("stature_m", settings.stature, 0.0, 2.5);
  section.read("walk", settings.walk);
  section.read_ms("latency_ms", settings.latency, Duration{0}, std::chrono::seconds(1));
  section.read("max_rate_hz", settings.max_rate_hz, 1.0, 240.0);
  for (ConfigReader& item : section.items("gloves")) {
    GloveFiles glove;
    item.read("hand", glove.hand);
    item.read("take", glove.take);
    if (glove.hand.empty())
      item.complain("hand",
                    "is missing: the .json that `chorus scan hand.png --out hand.bvh` writes");
    settings.gloves.push_back(std::move(glove));
  }
  return settings;
}

}  // namespace chorus::suit
