#include "services/ctl/record/recorded_clock.h"

#include <cmath>

#include "common/client/service_client.h"

namespace chorus::ctl {

record::ClockModel clock_of(const nlohmann::json& sensor) {
  const auto milliseconds = [&](const char* key) { return client::number_at(sensor, key); };
  const auto duration = [](double ms) { return from_seconds(ms / 1e3); };
  record::ClockModel clock;
  const bool walked = sensor.contains("clockFromWalkMilliseconds");
  const double offset = milliseconds("clockOffsetMilliseconds") -
                        (walked ? milliseconds("clockFromWalkMilliseconds") : 0.0);
  const double uncertainty = milliseconds(walked ? "clockUncertaintyWithoutWalkMilliseconds"
                                                 : "clockUncertaintyMilliseconds");
  if (!std::isfinite(offset) || !std::isfinite(uncertainty)) return clock;
  clock.ours_minus_theirs = duration(offset);
  clock.uncertainty = duration(uncertainty);
  const auto corrected = sensor.find("clockCorrected");
  if (corrected != sensor.end() && corrected->is_boolean() && corrected->get<bool>())
    clock.applied = clock.ours_minus_theirs;
  return clock;
}

}  // namespace chorus::ctl
