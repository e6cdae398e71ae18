// The judge's common ground: one draw of the simulated workshop, with everything that is true in
// it.  Every accuracy benchmark and accuracy test stands on it; algorithms never include it.
//
// A draw = profile x seed (which draws the sensors' parameters, the people, the walk and the hour)
// x optional stress x layout.  World of the scene: y up, y = 0 the floor, origin = workspace
// centre.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/synthetic/sensor_choice.h"
#include "fusion-server/registration/registration.h"

namespace chorus::bench {

struct Setting {
  /// Of sensor_choice.h, every parameter drawn from its interval by the seed; or "gauss": white
  /// noise only, exact clocks.
  std::string profile = "A";
  std::uint64_t seed = 1;
  std::vector<synthetic::Stress> stress = {};  ///< Not for "gauss".
  /// Single parameters of the sensor at a place changed after the draw; for A, B and D only.
  std::function<void(synthetic::kinect::Profile&, std::size_t place)> adjust = {};
  std::vector<Eigen::Isometry3d> places = ring_places(synthetic::Ring{});
  synthetic::PathKind walk = synthetic::PathKind::Random;
  std::size_t persons = 1;
  /// These instead of `persons` walkers; their time counts from 1970.
  std::vector<synthetic::Person> people = {};
  std::vector<synthetic::Occluder> occluders = {};
  /// The middle of the walk glides so far and back again during it (world) [m].
  Eigen::Vector3d glide = Eigen::Vector3d::Zero();
  /// Beyond what the profile says, every host's clock is off [s] and drifts [s/s] by up to so much,
  /// uniformly.
  double clock_offset = 0.0;
  double clock_drift = 0.0;
  Duration length = std::chrono::seconds(30);
};

struct Workshop {
  Setting setting;
  synthetic::Scene scene;
  Timestamp begin;                              ///< True time.
  std::vector<registration::WalkTrack> tracks;  ///< s1, s2, ...; stamped by their hosts' clocks.
  std::vector<synthetic::HostClock> clocks;
};

/// When the walk of a draw begins, true time.
[[nodiscard]] Timestamp begin_of(std::uint64_t seed);

/// Builds the scene and records every sensor.  Same setting, same frames.  An unknown profile is a
/// mistake of the caller (throws).
[[nodiscard]] Workshop draw_workshop(Setting setting);

/// The same frames, each joint with the true mean square of its error as its covariance, and how
/// the errors of two sensors hang together.
struct Confided {
  std::vector<registration::WalkTrack> tracks;  ///< None: the profile does not know its errors.
  synthetic::kinect::ColouredError coloured;
};
[[nodiscard]] Confided confided(const Workshop& workshop);

/// The frames stamped in the first `duration`: a shorter walk out of a longer one.
[[nodiscard]] std::vector<registration::WalkTrack> first_of(const Workshop& workshop,
                                                            Duration duration);

/// Four sensors side by side; the walk glides along them, and only neighbours share any of it.
[[nodiscard]] Setting row_of_four();

/// Two sensors of a ring, `angle` [rad] apart.
[[nodiscard]] std::vector<Eigen::Isometry3d> pair_places(double angle);

/// When a host's clock showed this.
[[nodiscard]] Timestamp true_time(const synthetic::HostClock& clock, Timestamp stamp);

/// The registered world as it truly lies in the scene when this sensor is the master: origin on the
/// floor under it, +z where it looks.
[[nodiscard]] Eigen::Isometry3d world_from_scene(const Workshop& workshop, const SensorId& master);

/// Where a sensor truly is in that world.
[[nodiscard]] Eigen::Isometry3d true_place(const Workshop& workshop, const SensorId& sensor,
                                           const SensorId& master);

/// The truth as a registration.
[[nodiscard]] Registration true_registration(const Workshop& workshop, const SensorId& master);

/// A person's true joints in that world.
[[nodiscard]] Skeleton<WorldSpace> true_body(const Workshop& workshop, std::size_t person,
                                             Timestamp instant, const SensorId& master);

/// "A dfa00b0ef4a8, gauss": what every result says about where its numbers come from.
[[nodiscard]] std::string described(const std::vector<std::string>& profiles);

}  // namespace chorus::bench
