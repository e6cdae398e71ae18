#include "services/sensor/device/bridge/pushed_orientations.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "common/resource/inertial_readings.h"
#include "services/sensor/device/bridge/json_value.h"

namespace chorus::bridge {

using Json = nlohmann::json;

Result<Heading> read_heading(const Json& message) {
  Heading heading;
  const Json* captured = find(message, "captured");
  if (captured == nullptr) return wrong(At{}["captured"], "is missing; when light hit the sensor");
  const auto stamp = read_stamp(*captured, At{}["captured"]);
  if (!stamp) return pass(stamp);
  heading.captured = *stamp;
  if (const Json* sequence = find(message, "sequence")) {
    const auto number = read_whole(*sequence, At{}["sequence"]);
    if (!number) return pass(number);
    heading.sequence = *number;
  }
  return heading;
}

Result<PushedOrientations> read_pushed_orientations(const Json& message) {
  const auto heading = read_heading(message);
  if (!heading) return pass(heading);
  const Json* readings = find(message, "readings");
  if (readings == nullptr) return wrong(At{}["readings"], "is missing; {} when no sensor speaks");
  auto read = resource::read_readings(*readings, heading->captured);
  if (!read) return pass(read);
  inertial::InertialFrame instant;
  instant.captured = heading->captured;
  instant.readings = std::move(*read);
  auto checked = inertial::checked(std::move(instant));
  if (!checked) return pass(checked);
  return PushedOrientations{heading->sequence, std::move(*checked)};
}

}  // namespace chorus::bridge
