#include "services/ctl/align/person_place.h"

#include <cmath>

#include <Eigen/Core>

#include "common/client/service_client.h"

namespace chorus::ctl {
namespace {

constexpr double kSure = 0.95;  // Smallest certainty of left and right.
// Smallest sum of the vectors from right to left [m]; below it, the front is undefined.
constexpr double kNarrowest = 0.05;

Eigen::Vector2d on_floor(const nlohmann::json& joints, const char* name) {
  const auto& joint = client::part_at(joints, name);
  return {client::number_at(joint, "x"), client::number_at(joint, "z")};
}

}  // namespace

Result<alignment::FloorPose> person_place(const nlohmann::json& frame) {
  const auto& bodies = client::part_at(frame, "bodies");
  if (bodies.empty())
    return fail(ErrorCode::NotFound, "origin", "nobody is seen; stand where the world shall begin");
  if (bodies.size() > 1)
    return fail(ErrorCode::Conflict, "origin",
                "more than one person is seen; only the one who shows the origin may be");
  const auto& body = bodies.front();
  const double sure = client::number_at(body, "sidesConfidence");
  if (std::isfinite(sure) && sure < kSure)
    return fail(ErrorCode::Unavailable, "origin",
                "which way the person faces is uncertain; walk a few steps and come back");
  const auto& joints = client::part_at(body, "joints");
  const Eigen::Vector2d pelvis = on_floor(joints, "SpineBase");
  const Eigen::Vector2d left = on_floor(joints, "HipLeft") - on_floor(joints, "HipRight") +
                               on_floor(joints, "ShoulderLeft") - on_floor(joints, "ShoulderRight");
  if (!pelvis.allFinite() || !(left.norm() > kNarrowest))
    return fail(ErrorCode::NotFound, "origin",
                "hips or shoulders are not seen; turn or step aside");
  // The front is left x up, with +y up: (lx, 0, lz) x (0, 1, 0) = (-lz, 0, lx).
  return alignment::FloorPose{pelvis.x(), pelvis.y(), std::atan2(-left.y(), left.x())};
}

}  // namespace chorus::ctl
