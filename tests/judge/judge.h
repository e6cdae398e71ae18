// The judge: one draw of the simulated workshop, with the complete truth.  Every accuracy benchmark
// and accuracy test depends on it; algorithms never include it.
//
// A draw follows from a profile, a seed (which determines the sensors' parameters, the people, the
// walk and when it begins), optional stress and a layout.  World of the scene: y up, y = 0 the
// floor, origin = workspace centre.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/synthetic/sensor_choice.h"
#include "fusion-server/registration/registration.h"

namespace chorus::bench {

struct Setting {
  /// A profile of sensor_choice.h, each parameter of which is drawn from its interval by the seed;
  /// or "gauss": white noise only, exact clocks.
  std::string profile = "A";
  std::uint64_t seed = 1;
  std::vector<synthetic::Stress> stress = {};  ///< Not for "gauss".
  /// Changes parameters of the sensor at `place` after the draw; for A, B and D only.
  std::function<void(synthetic::kinect::Profile&, std::size_t place)> adjust = {};
  std::vector<Eigen::Isometry3d> places = ring_places(synthetic::Ring{});
  synthetic::PathKind walk = synthetic::PathKind::Random;
  std::size_t persons = 1;
  /// If not empty, these people are used instead of `persons` walkers; their time counts from 1970.
  std::vector<synthetic::Person> people = {};
  std::vector<synthetic::Occluder> occluders = {};
  /// During the walk its middle moves by this vector and back again (world) [m].
  Eigen::Vector3d glide = Eigen::Vector3d::Zero();
  /// Each host's clock is off [s] and drifts [s/s] by at most this much, uniformly distributed, in
  /// addition to the errors of the profile.
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

/// When the walk of a draw begins, in true time.
[[nodiscard]] Timestamp begin_of(std::uint64_t seed);

/// Builds the scene and records every sensor.  The same setting gives the same frames.  An unknown
/// profile is an error of the caller (throws).
[[nodiscard]] Workshop draw_workshop(Setting setting);

/// The frames of a draw, in which each joint has the true mean square of its error as its
/// covariance, and how the errors of two sensors correlate.
struct Confided {
  std::vector<registration::WalkTrack> tracks;  ///< Empty: the profile does not know its errors.
  synthetic::kinect::ColouredError coloured;
};
[[nodiscard]] Confided confided(const Workshop& workshop);

/// The frames stamped within the first `duration`: turns a longer walk into a shorter one.
[[nodiscard]] std::vector<registration::WalkTrack> first_of(const Workshop& workshop,
                                                            Duration duration);

/// Four sensors side by side; the walk moves along them, and only neighbours see a common part.
[[nodiscard]] Setting row_of_four();

/// Poses of two sensors of a ring, `angle` [rad] apart.
[[nodiscard]] std::vector<Eigen::Isometry3d> pair_places(double angle);

/// The true time at which a host's clock showed `stamp`.
[[nodiscard]] Timestamp true_time(const synthetic::HostClock& clock, Timestamp stamp);

/// The pose of the scene in the world that a registration with this master should find: origin on
/// the floor below the master, +z in its viewing direction.
[[nodiscard]] Eigen::Isometry3d world_from_scene(const Workshop& workshop, const SensorId& master);

/// The true pose of a sensor in the world of `master`.
[[nodiscard]] Eigen::Isometry3d true_place(const Workshop& workshop, const SensorId& sensor,
                                           const SensorId& master);

/// The truth as a registration.
[[nodiscard]] Registration true_registration(const Workshop& workshop, const SensorId& master);

/// A person's true joints in the world of `master`.
[[nodiscard]] Skeleton<WorldSpace> true_body(const Workshop& workshop, std::size_t person,
                                             Timestamp instant, const SensorId& master);

/// Names the profiles with the hashes of their parameters: "A dfa00b0ef4a8, gauss".
[[nodiscard]] std::string described(const std::vector<std::string>& profiles);

}  // namespace chorus::bench
