// Reads any bytes as a SlimeVR datagram and as each file of inertial sensors: values that can be
// relied on, or a reason.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "common/inertial/dot_csv.h"
#include "common/inertial/mtw_log.h"
#include "common/inertial/orientation_table.h"
#include "common/inertial/slimevr.h"

namespace {

using namespace chorus;
using namespace chorus::inertial;

void require(bool holds) {
  if (!holds) std::abort();
}

/// A rotation that was read is of unit length, and is read again from what is written of it.
void check_datagram(std::string_view bytes) {
  const auto packets = slimevr::parse(bytes);
  if (!packets) return;
  for (const slimevr::Packet& packet : *packets) {
    const auto* const rotation = std::get_if<slimevr::Rotation>(&packet.content);
    if (rotation == nullptr) continue;
    require(std::abs(rotation->world_from_tracker.norm() - 1.0) < 1e-6);
    require(slimevr::parse(slimevr::encode(packet)).has_value());
  }
}

void check_log(const Result<SensorLog>& log) {
  if (!log) return;
  require(!log->readings.empty());
  for (const InertialReading& reading : log->readings)
    require(std::abs(reading.inertial_from_sensor->norm() - 1.0) < 1e-6);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  check_datagram(text);
  check_log(parse_mtw_log(text, "fuzz", "sensor"));
  check_log(parse_dot_csv(text, "fuzz"));
  if (const auto logs = parse_orientation_table(text, "fuzz"))
    for (const SensorLog& log : *logs) check_log(log);
  return 0;
}
