// What counts as a sensor that was moved.
#pragma once

namespace chorus::watch {

struct WatchConfig {
  bool enabled = false;
  /// People must appear displaced by this much before a sensor counts as moved [m] ...
  double least_shift = 0.04;
  /// ... and by this many standard deviations of what is usual for that sensor.
  double least_sigmas = 5.0;
  /// A place that is off by this much for minutes counts as drifted [m].
  double least_drift = 0.06;

  bool operator==(const WatchConfig&) const = default;
};

}  // namespace chorus::watch
