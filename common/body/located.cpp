#include "common/body/located.h"

#include <span>

#include "common/body/bones.h"

namespace chorus {
namespace {

std::optional<Eigen::Vector3d> mean_of(std::span<const std::optional<Eigen::Vector3d>> joints) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const auto& place : joints) {
    if (!place) continue;
    sum += *place;
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return Eigen::Vector3d(sum / count);
}

}  // namespace

Located points_of(const Skeleton<WorldSpace>& body) {
  Located points;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (body.joints[i].seen()) points[i] = body.joints[i].position;
  }
  return points;
}

std::optional<Eigen::Vector3d> middle_of(const Located& body) {
  std::array<std::optional<Eigen::Vector3d>, kCoreJoints.size()> core;
  for (std::size_t i = 0; i < core.size(); ++i) core[i] = body[index_of(kCoreJoints[i])];
  if (const auto mean = mean_of(core)) return mean;
  return mean_of(body);
}

}  // namespace chorus
