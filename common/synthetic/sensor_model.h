// What one simulated sensor reports of a scene: several small layers, applied in order.
//
// This is the plain profile, "gauss": limited view, joints hidden by things, white Gaussian noise,
// jittered time, dropped frames.  The error of a real Kinect is coloured and depends on the view,
// and a real Kinect swaps left and right when it sees a person from behind.  This model does none
// of that, so accuracy measured with it is better than in reality for every method.  Everything is
// a pure function of (scene, sensor, frame number).
#pragma once

#include <cstdint>
#include <optional>

#include "common/base/units.h"
#include "common/sensor/sensor_frame.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic {

inline constexpr std::string_view kGaussProfile = "gauss";

/// When frames are taken.  Source: real logs, in which steps are 32.6-33.0 ms and a few % of the
/// frames are lost.
struct Sampling {
  Duration period{33'333'333};                     ///< 30 Hz
  Duration jitter = std::chrono::milliseconds(2);  ///< Uniform within +- this.
  double drop_share = 0.0;  ///< Share of frames lost; each is lost independently.
};

/// Which joints are in view.  Source: Kinect v2, 70 x 60 deg, 0.5-4.5 m.
struct FieldOfView {
  double half_width = deg(35);   ///< [rad]
  double half_height = deg(30);  ///< [rad]
  /// [rad]; a joint up to this far outside is Inferred, one farther outside is not tracked.
  double margin = deg(8);
  double least_range = 0.5;  ///< [m]
  double most_range = 4.5;   ///< [m]
};

/// White noise along and across the line of sight.
struct GaussianNoise {
  double along = 0.025;          ///< Standard deviation [m]
  double across = 0.010;         ///< Standard deviation per axis [m]
  double inferred_factor = 2.5;  ///< Factor on the noise of Inferred joints.
  double turn = deg(4);          ///< Noise of orientations, per axis [rad]
};

/// The floor plane as the sensor estimates it: a fixed error per sensor and a small one per frame.
struct FloorNoise {
  double fixed_tilt = deg(0.15);  ///< Standard deviation per axis [rad]
  double fixed_offset = 0.003;    ///< [m]
  double tilt = deg(0.1);         ///< Per frame [rad]
  double offset = 0.003;          ///< [m]
};

struct SensorModel {
  std::uint64_t seed = 1;
  Sampling sampling;
  FieldOfView view;
  GaussianNoise noise;
  FloorNoise floor;
};

/// One sensor of the scene; `index` is also a part of the key of its random numbers.
struct SimulatedSensor {
  SensorId id;
  std::size_t index = 0;
  SensorModel model;
};

/// Capture time of frame `number`, with the sensor's phase and jitter.  Numbers count periods since
/// 1970.
[[nodiscard]] Timestamp capture_time(const SimulatedSensor& sensor, std::uint64_t number);

/// The first frame captured at or after `instant`.
[[nodiscard]] std::uint64_t first_frame_from(const SimulatedSensor& sensor, Timestamp instant);

/// Frame `number`; none when it is dropped or the scene lacks the sensor.  `sequence` is the
/// number; `received` equals `captured`.
[[nodiscard]] std::optional<SensorFrame> observe(const Scene& scene, const SimulatedSensor& sensor,
                                                 std::uint64_t number);

/// The layers, one by one, for tests and other profiles.
void limit_view(Skeleton<SensorSpace>& body, const FieldOfView& view);
/// Joints hidden by the box become Inferred.
void hide_behind(Skeleton<SensorSpace>& body, const Eigen::Isometry3d& box_from_sensor,
                 const Eigen::Vector3d& half);
void add_noise(Skeleton<SensorSpace>& body, const GaussianNoise& noise, Draw draw);

}  // namespace chorus::synthetic
