#include "common/inertial/sensor_log.h"

#include <algorithm>
#include <map>
#include <set>

namespace chorus::inertial {

Result<std::vector<InertialFrame>> frames_of(const std::vector<SensorLog>& logs,
                                             const SensorId& source) {
  std::set<std::string> names;
  double fastest = 1.0;
  for (const SensorLog& log : logs) {
    if (!names.insert(log.sensor).second)
      return fail(ErrorCode::Conflict, "sensor " + log.sensor,
                  "is in two of the files; give each sensor a name of its own");
    fastest = std::max(fastest, log.rate_hz);
  }
  const auto slot = static_cast<std::int64_t>(1e9 / fastest);
  std::map<std::int64_t, InertialFrame> frames;
  for (const SensorLog& log : logs) {
    for (const InertialReading& reading : log.readings) {
      const std::int64_t at = to_unix_ns(reading.captured);
      InertialFrame& frame = frames[(at + slot / 2) / slot];
      if (frame.readings.empty()) frame.captured = reading.captured;
      const bool there = std::ranges::any_of(
          frame.readings, [&](const auto& each) { return each.sensor == reading.sensor; });
      if (!there) frame.readings.push_back(reading);
    }
  }
  std::vector<InertialFrame> out;
  for (auto& [index, frame] : frames) {
    frame.source = source;
    frame.received = frame.captured;
    frame.sequence = out.size() + 1;
    auto fine = checked(std::move(frame));
    if (!fine) return pass(fine);
    out.push_back(std::move(*fine));
  }
  return out;
}

std::vector<std::string> heading_notes(const std::vector<SensorLog>& logs) {
  std::vector<std::string> out;
  for (const SensorLog& log : logs) {
    const bool drifts = std::ranges::any_of(
        log.readings, [](const auto& r) { return r.magnetic == MagneticState::None; });
    if (drifts) out.push_back("sensor " + log.sensor + " has no magnetometer: its heading drifts");
  }
  return out;
}

}  // namespace chorus::inertial
