#include "fusion-server/server/health.h"

#include <cstddef>

namespace chorus::server {

service::Health health_of(const Status& status) {
  std::size_t live = 0;
  for (const SensorStatus& sensor : status.sensors) live += sensor.state == "live" ? 1 : 0;
  if (live == 0) return {false, "none of the sensors delivers frames; see /sensors/"};
  if (status.progress.unpolled.size() == status.registration.sensors.size()) {
    return {false, "the sensors are not registered yet; walk through the room, see /registration"};
  }
  const StorageStatus& storage = status.progress.storage;
  if (!storage.trouble.empty()) return {true, "the registration is not stored: " + storage.trouble};
  return {true, storage.damage};
}

service::Health with_outputs(service::Health health, const std::vector<OutputStatus>& states) {
  for (const OutputStatus& one : states) {
    if (one.error.empty() || !health.ready) continue;
    health.reason += (health.reason.empty() ? "" : "; ") + one.name + " is not open: " + one.error;
  }
  return health;
}

}  // namespace chorus::server
