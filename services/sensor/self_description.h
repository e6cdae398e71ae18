// `/`: what this service is, with links to all it has, for people and for machines.
#pragma once

#include <string>

#include "common/base/strong_id.h"
#include "common/http/document.h"
#include "common/resource/node.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/sight.h"

namespace chorus::sensor_service {

struct Self {
  SensorId id;
  DeviceDescription device;
  bool images = false;
};

[[nodiscard]] resource::Node self_node(const Self& self);
/// A page for browsers; every text from outside is escaped.
[[nodiscard]] std::string self_page(const Self& self);
[[nodiscard]] http::DocumentPtr self_document(const Self& self, const Serving& serving);

}  // namespace chorus::sensor_service
