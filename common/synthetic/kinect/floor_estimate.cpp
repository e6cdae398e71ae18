#include "common/synthetic/kinect/floor_estimate.h"

#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic::kinect {
namespace {

enum Purpose : std::uint64_t { kFloorFixed = 981, kFloorNow };

}  // namespace

FloorPlane estimated_floor(const Eigen::Isometry3d& world_from_sensor, std::uint64_t number,
                           const FloorError& error, const ErrorKeys& keys) {
  Draw fixed{kFloorFixed, keys.seed, keys.sensor};
  Draw now{kFloorNow, keys.seed, keys.sensor, number};
  const Plane exact = floor_in_sensor(world_from_sensor);
  const Eigen::Vector3d tilt = error.tilt * fixed.gauss3() + error.tilt_now * now.gauss3();
  return {exp_map(tilt) * exact.normal,
          exact.offset + error.offset * fixed.gauss() + error.offset_now * now.gauss()};
}

}  // namespace chorus::synthetic::kinect
