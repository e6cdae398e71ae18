#include "tests/judge/joint_error.h"

#include <limits>

namespace chorus::bench {

double JointError::mean() const {
  return joints > 0 ? sum / static_cast<double>(joints) : std::numeric_limits<double>::quiet_NaN();
}

double JointError::coverage() const {
  return asked > 0 ? static_cast<double>(joints) / static_cast<double>(asked) : 0.0;
}

void compare(const Skeleton<WorldSpace>& body, const Skeleton<WorldSpace>& exact,
             JointError& error) {
  error.asked += kJointCount;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!body.joints[i].seen()) continue;
    error.sum += (body.joints[i].position - exact.joints[i].position).norm();
    ++error.joints;
  }
}

JointError fused_error(const Workshop& workshop, const std::vector<Snapshot>& snapshots,
                       const SensorId& master) {
  JointError error;
  for (const Snapshot& snapshot : snapshots) {
    compare(snapshot.bodies.empty() ? Skeleton<WorldSpace>{} : snapshot.bodies.front().skeleton,
            true_body(workshop, 0, snapshot.instant, master), error);
  }
  return error;
}

JointError raw_error(const Workshop& workshop, std::size_t sensor,
                     const Registration& registration) {
  const registration::WalkTrack& track = workshop.tracks[sensor];
  const auto place = registration.sensors.find(track.sensor);
  JointError error;
  if (place == registration.sensors.end()) return error;
  for (const SensorFrame& frame : track.frames) {
    const Timestamp exposed = true_time(workshop.clocks[sensor], frame.captured);
    compare(frame.bodies.empty()
                ? Skeleton<WorldSpace>{}
                : to_world(place->second.world_from_sensor, frame.bodies.front().skeleton),
            true_body(workshop, 0, exposed, registration.master), error);
  }
  return error;
}

}  // namespace chorus::bench
