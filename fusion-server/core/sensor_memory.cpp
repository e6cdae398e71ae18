#include "fusion-server/core/sensor_memory.h"

#include <algorithm>

namespace chorus::core {
namespace {

constexpr double kBlend = 1.0 / 30.0;

void blend(double& average, double now) { average += kBlend * (now - average); }

}  // namespace

void note_shares(const Snapshot& snapshot, const std::vector<SensorId>& awaited,
                 SensorMemories& sensors) {
  for (const SensorId& sensor : snapshot.sensors) {
    const bool last = std::ranges::find(awaited, sensor) != awaited.end();
    blend(sensors[sensor].share.awaited, last ? 1.0 : 0.0);
  }
  for (const auto& [sensor, part] : parts_of(snapshot)) blend(sensors[sensor].share.in_time, part);
}

void note_settled(const Parts& parts, SensorMemories& sensors) {
  for (const auto& [sensor, part] : parts) blend(sensors[sensor].share.afterwards, part);
}

}  // namespace chorus::core
