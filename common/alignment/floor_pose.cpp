#include "common/alignment/floor_pose.h"

#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "common/base/units.h"

namespace chorus::alignment {
namespace {

constexpr double kStill = 0.10;     // Largest movement [m].
constexpr double kTurned = 10.0;    // Largest turn [deg].
constexpr std::size_t kEnough = 5;  // Smallest number of frames.

double turned(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

}  // namespace

Result<FloorPose> steady(std::span<const FloorPose> seen) {
  if (seen.size() < kEnough)
    return fail(ErrorCode::NotFound, "origin", "too few frames came; is the tracker running?");
  FloorPose mean;
  Eigen::Vector2d front = Eigen::Vector2d::Zero();
  for (const FloorPose& each : seen) {
    mean.x += each.x / static_cast<double>(seen.size());
    mean.z += each.z / static_cast<double>(seen.size());
    front += Eigen::Vector2d(std::sin(each.yaw), std::cos(each.yaw));
  }
  mean.yaw = std::atan2(front.x(), front.y());
  for (const FloorPose& each : seen) {
    if (std::hypot(each.x - mean.x, each.z - mean.z) > kStill ||
        turned(each.yaw, mean.yaw) > deg(kTurned))
      return fail(ErrorCode::Conflict, "origin",
                  "the person moved or turned; stand still and retry");
  }
  return mean;
}

}  // namespace chorus::alignment
