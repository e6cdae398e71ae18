#include "fusion-server/fusion/view_misfit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "fusion-server/fusion/joint_filters.h"

namespace chorus::fusion {
namespace {

using enum JointId;

constexpr double kLeastTurn = 0.005;  // [rad] prior for the turn of a frontal view
constexpr double kOff = 1e-9;         // prior of a nuisance parameter that is switched off
constexpr double kNarrow = 0.1;       // [m] shoulders closer together give no direction

/// The centres of scaling and turning.
struct Centres {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const PlacedBody& body;
};

/// The end of the spine that a joint is connected to.
std::size_t axis_of(std::size_t joint) {
  static const auto kAxis = [] {
    std::array<std::size_t, kJointCount> axis{};
    for (std::size_t j = 0; j < kJointCount; ++j) {
      auto id = static_cast<JointId>(j);
      while (!in_trunk(id)) id = parent_of(id);
      axis[j] = index_of(id);
    }
    return axis;
  }();
  return kAxis[joint];
}

/// Derivatives d z_j / d scale and d z_j / d turn.
Eigen::Matrix<double, 3, 2> slopes_at(std::size_t joint, const Centres& at) {
  const Eigen::Vector3d& place = at.body[joint].position;
  Eigen::Matrix<double, 3, 2> slopes = Eigen::Matrix<double, 3, 2>::Zero();
  slopes.col(0) = place - at.middle;
  const std::size_t axis = axis_of(joint);
  if (!in_trunk(static_cast<JointId>(joint)) && at.body[axis].placed) {
    const Eigen::Vector3d lever = place - at.body[axis].position;
    slopes.col(1) = Eigen::Vector3d(lever.z(), 0.0, -lever.x());
  }
  return slopes;
}

/// The view's position of a joint, corrected for the misfit.
Eigen::Vector3d mended_at(std::size_t joint, const SeenBody& seen, const Centres& at,
                          const Misfit& misfit) {
  Eigen::Vector3d place = seen.place[joint];
  const std::size_t axis = axis_of(joint);
  if (!in_trunk(static_cast<JointId>(joint)) && at.body[axis].placed) {
    const Eigen::Vector3d& about = at.body[axis].position;
    place = about + about_y(-misfit.turn) * (place - about);
  }
  return place - misfit.scale * (at.body[joint].position - at.middle);
}

/// Angle between the direction of sight and frontal, from the front or the rear alike [rad].
double side_on(const SeenBody& seen, const Centres& at) {
  const PlacedJoint& left = at.body[index_of(ShoulderLeft)];
  const PlacedJoint& right = at.body[index_of(ShoulderRight)];
  if (!left.placed || !right.placed) return 0.0;
  const Eigen::Vector3d across = left.position - right.position;
  const Eigen::Vector3d sight = at.middle - seen.eye;
  const Eigen::Vector2d line(across.x(), across.z());
  const Eigen::Vector2d ray(sight.x(), sight.z());
  if (!(line.norm() > kNarrow) || !(ray.norm() > 0)) return 0.0;
  return std::asin(std::min(1.0, std::abs(line.dot(ray)) / (line.norm() * ray.norm())));
}

double turn_sigma(const SeenBody& seen, const Centres& at, const BodyModel& model) {
  if (!(model.turn > 0)) return kOff;
  const double span = std::max(kOff, model.turn_full - model.turn_from);
  const double share = (side_on(seen, at) - model.turn_from) / span;
  return kLeastTurn + model.turn * std::clamp(share, 0.0, 1.0);
}

}  // namespace

std::optional<Eigen::Vector3d> middle_of(const PlacedBody& body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const JointId id : kCoreJoints) {
    if (!body[index_of(id)].placed) continue;
    sum += body[index_of(id)].position;
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return Eigen::Vector3d(sum / count);
}

Misfit misfit_of(const SeenBody& seen, const PlacedBody& body, const Misfit& before,
                 const BodyModel& model) {
  const auto middle = middle_of(body);
  if (!middle) return {};
  const Centres at{*middle, body};
  const double turn = turn_sigma(seen, at, model);
  const double scale = std::max(kOff, model.scale);
  const Eigen::Vector2d prior(1 / (scale * scale), 1 / (turn * turn));
  Eigen::Matrix2d information = prior.asDiagonal();
  Eigen::Vector2d right = -prior.cwiseProduct(Eigen::Vector2d(before.scale, before.turn));
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!(seen.variance[j] > 0) || !body[j].placed) continue;
    const auto slopes = slopes_at(j, at);
    const Eigen::Vector3d off = mended_at(j, seen, at, before) - body[j].position;
    const double distance = off.norm() / std::sqrt(seen.variance[j]);
    const bool far = model.huber > 0 && distance > model.huber;
    const double weight = (far ? model.huber / distance : 1.0) / seen.variance[j];
    information += weight * slopes.transpose() * slopes;
    right += weight * slopes.transpose() * off;
  }
  const Eigen::Vector2d more = information.inverse() * right;
  return {before.scale + more.x(), before.turn + more.y()};
}

std::array<Eigen::Vector3d, kJointCount> mended(const SeenBody& seen, const PlacedBody& body,
                                                const Misfit& misfit) {
  auto places = seen.place;
  const auto middle = middle_of(body);
  if (!middle) return places;
  const Centres at{*middle, body};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!(seen.variance[j] > 0) || !body[j].placed) continue;
    places[j] = mended_at(j, seen, at, misfit);
  }
  return places;
}

}  // namespace chorus::fusion
