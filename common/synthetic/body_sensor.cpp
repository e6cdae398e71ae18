#include "common/synthetic/body_sensor.h"

namespace chorus::synthetic {

std::vector<SensorFrame> record(BodySensor& sensor, Timestamp end) {
  std::vector<SensorFrame> frames;
  while (sensor.next_exposure() <= end) {
    if (auto frame = sensor.next()) frames.push_back(*std::move(frame));
  }
  return frames;
}

}  // namespace chorus::synthetic
