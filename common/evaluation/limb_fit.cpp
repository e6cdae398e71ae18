#include "common/evaluation/limb_fit.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/evaluation/limb_frame.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

// What one view errs by in a bone's direction, about one axis [rad]: two real cameras leave a
// median of 11 to 26 degrees.
constexpr double kViewSigma = deg(20);
// A shorter line has no direction: [m], or the sine of the angle between two rays.
constexpr double kShortestLine = 0.02;
constexpr double kLeastAcross = 0.5;  // part of a bone that must lie across the line of sight

/// A line between two joints, and the axis of the limb that it is parallel to.
struct Line {
  JointId from, to;
  Eigen::Vector3d axis;
};

std::optional<Line> line_of(Limb limb) {
  using enum JointId;
  if (limb == Limb::Head) return std::nullopt;
  // limb_from_joints() puts +z of the trunk to where the line across it points.
  if (limb == Limb::Pelvis) return Line{HipRight, HipLeft, Eigen::Vector3d::UnitZ()};
  if (limb == Limb::Chest) return Line{ShoulderRight, ShoulderLeft, Eigen::Vector3d::UnitZ()};
  const LimbBone bone = bone_of(limb);
  return Line{bone.from, bone.to, Eigen::Vector3d::UnitY()};
}

Eigen::Vector3d across(const Eigen::Vector3d& v, const Eigen::Vector3d& sight) {
  return v - sight * sight.dot(v);
}

/// The line's direction; none if it is not seen.
std::optional<Eigen::Vector3d> direction(const Skeleton<WorldSpace>& seen, const Line& line,
                                         const Eigen::Vector3d& sight) {
  const Joint& from = seen[line.from];
  const Joint& to = seen[line.to];
  if (!from.given() || !to.given() || from.measurement != to.measurement) return std::nullopt;
  const Eigen::Vector3d v = across(to.position - from.position, sight);
  if (!(v.norm() > kShortestLine)) return std::nullopt;
  return Eigen::Vector3d(v.normalized());
}

double misfit(const Eigen::Vector3d& seen, const Eigen::Vector3d& said, double variance) {
  const double angle = std::atan2(seen.cross(said).norm(), seen.dot(said));
  return std::min(kWorstFit, angle * angle / variance);
}

}  // namespace

std::optional<LimbFit> limb_fit(const Skeleton<WorldSpace>& seen, const LimbSaid& said,
                                const Eigen::Vector3d& sight) {
  const auto line = line_of(said.limb);
  if (!line) return std::nullopt;
  const Eigen::Vector3d axis = said.world_from_limb * line->axis;
  const Eigen::Vector3d shown = across(axis, sight);
  // Of the two axes across; not a number where the covariance is not.
  const double stated = 0.5 * (said.covariance.trace() - axis.dot(said.covariance * axis));
  if (!(shown.norm() > kLeastAcross) || !(stated >= 0)) return std::nullopt;
  const auto labelled = direction(seen, *line, sight);
  const auto exchanged = direction(seen, {mirror(line->from), mirror(line->to), line->axis}, sight);
  if (!labelled || !exchanged) return std::nullopt;
  const double variance = stated + kViewSigma * kViewSigma;
  const Eigen::Vector3d u = shown.normalized();
  return LimbFit{misfit(*labelled, u, variance), misfit(*exchanged, u, variance)};
}

}  // namespace chorus::evaluation
