#include "common/synthetic/kinect/floor_estimate.h"

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic::kinect {
namespace {

enum Purpose : std::uint64_t { kFloorFixed = 981, kFloorNow };

// Otto 7.3 sees at most 1.5 deg of pitch; real floor planes scatter by 0.1-0.2 deg (notes on
// algorithms, 1.4).
constexpr double kFloorTilt = deg(0.3);
constexpr double kFloorOffset = 0.006;  // [m]
constexpr double kFloorTiltNow = deg(0.1);
constexpr double kFloorOffsetNow = 0.003;  // [m]

}  // namespace

FloorPlane estimated_floor(const Eigen::Isometry3d& world_from_sensor, std::uint64_t number,
                           const ErrorKeys& keys) {
  Draw fixed{kFloorFixed, keys.seed, keys.sensor};
  Draw now{kFloorNow, keys.seed, keys.sensor, number};
  const Plane exact = floor_in_sensor(world_from_sensor);
  const Eigen::Vector3d tilt = kFloorTilt * fixed.gauss3() + kFloorTiltNow * now.gauss3();
  return {exp_map(tilt) * exact.normal,
          exact.offset + kFloorOffset * fixed.gauss() + kFloorOffsetNow * now.gauss()};
}

}  // namespace chorus::synthetic::kinect
