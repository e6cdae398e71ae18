// Makes a simulated sensor from the name of its profile.  "A", "B" and "D" draw their errors
// (kinect/); in "C" errors emerge from depth images and a body fitter (depth/); "gauss" has only
// white noise (sensor_model.h).
//
// The parameters are the nominal ones, or drawn from their intervals; each source of error can also
// be scaled or switched off (but see SensorChoice::gauss).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/synthetic/body_sensor.h"
#include "common/synthetic/kinect/error_source.h"
#include "common/synthetic/scene.h"
#include "common/synthetic/sensor_model.h"

namespace chorus::synthetic {

using kinect::Source;

/// The factor of one source of error: 0 switches it off, 1 leaves it unchanged.
struct Stress {
  Source source = Source::White;
  double factor = 1.0;
};

struct SensorChoice {
  SensorId id;
  std::size_t place = 0;              ///< Index into Scene::world_from_sensor.
  std::string profile = "A";          ///< "A", "B", "C", "D" or "gauss"
  std::optional<std::uint64_t> draw;  ///< Seed for drawing the parameters; none: nominal ones.
  std::vector<Stress> stress = {};
  /// Seed of errors; the same for all sensors of a room, because they share some errors.
  std::uint64_t seed = 1;
  /// Seed of the biases of the SDK and of people; meant to be the same in every run.
  std::uint64_t bias_seed = 1;
  bool own_clock = true;  ///< True: stamps frames by the host's erring clock; false: by true time.
  /// The parameters of "gauss".  It has no intervals to draw from, no sources to scale, and an
  /// exact clock.
  SensorModel gauss = {};
};

/// True if the errors of this profile are drawn (kinect/).
[[nodiscard]] bool is_drawn(std::string_view profile);

/// `scene` must outlive the sensor.  The first frames are at or after `start`.  Refuses an unknown
/// profile, and an index that the scene lacks.
[[nodiscard]] Result<std::unique_ptr<BodySensor>> make_sensor(const Scene& scene,
                                                              const SensorChoice& choice,
                                                              Timestamp start);

/// All frames of one sensor from start to end.
[[nodiscard]] Result<std::vector<SensorFrame>> record(const Scene& scene,
                                                      const SensorChoice& choice, Timestamp start,
                                                      Timestamp end);

/// First 12 hex digits of the SHA-256 of what defines the profile; printed with results. Empty for
/// "gauss", which is not frozen, and for an unknown profile.
[[nodiscard]] std::string frozen_hash(std::string_view profile);

}  // namespace chorus::synthetic
