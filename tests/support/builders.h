// Simple, plausible values for tests: a standing person, a sensor that looks at them, a frame of
// both.
//
// The person is 1.75 m tall, faces +z at heading 0 and has its left hand at +x.  Metres, radians.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/body/skeleton.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::testing {

/// 2026-11-21T07:30:00Z: a fixed instant to count from.
inline constexpr Timestamp kStart = from_unix_ns(1'795'246'200'000'000'000);

/// Capture interval of a 30 Hz sensor.
inline constexpr Duration kFrameInterval{33'333'333};

/// Upright with arms hanging down.  `place` is the point on the floor below SpineBase.  All joints
/// are tracked; the leaves (head, hand tips, thumbs, feet) have no orientation, as with the Kinect.
[[nodiscard]] Skeleton<WorldSpace> standing_person(const Eigen::Vector3d& place = {0, 0, 0},
                                                   double heading = 0.0);

/// A standing person with arms stretched out sideways.
[[nodiscard]] Skeleton<WorldSpace> t_pose_person(const Eigen::Vector3d& place = {0, 0, 0},
                                                 double heading = 0.0);

/// A sensor at `place`, looking along +z turned by `yaw` about +y, tilted down by `pitch`.
[[nodiscard]] Eigen::Isometry3d sensor_pose(const Eigen::Vector3d& place, double yaw,
                                            double pitch = 0.0);

/// Sensor `index` of `count`, evenly spaced on a circle around the origin, level, looking at the
/// axis.  Sensor 0 stands at (0, height, -radius) and looks along +z.
[[nodiscard]] Eigen::Isometry3d ring_sensor(int index, int count, double radius = 2.5,
                                            double height = 1.2);

/// The floor y = 0 as a sensor at this pose sees it.
[[nodiscard]] FloorPlane floor_seen_from(const Eigen::Isometry3d& world_from_sensor);

/// What a perfect sensor sees of a person.
[[nodiscard]] BodyFrame body_seen_from(const Eigen::Isometry3d& world_from_sensor,
                                       const Skeleton<WorldSpace>& person, Timestamp captured,
                                       std::uint64_t body_id = 1);

/// A frame of one sensor with captured = received; its sequence counts frames since kStart.
[[nodiscard]] SensorFrame sensor_frame(std::string_view sensor, Timestamp captured,
                                       std::vector<BodyFrame> bodies);

/// An id that must be valid; otherwise the test program aborts.
[[nodiscard]] SensorId sensor_id(std::string_view text);

/// Makes the joint NotTracked.
void hide(Joint& joint);

}  // namespace chorus::testing
