#include "fusion-server/fusion/view_misfit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

#include "common/body/bones.h"
#include "fusion-server/fusion/joint_filters.h"

namespace chorus::fusion {
namespace {

using enum JointId;

constexpr double kLeastTurn = 0.005;  // [rad] prior for the turn of a frontal view
constexpr double kOff = 1e-9;         // prior of a nuisance parameter that is switched off
constexpr double kNarrow = 0.1;       // [m] shoulders closer together give no direction

/// How the joints are attached to the spine.
struct Hanging {
  std::array<std::size_t, kJointCount> axis{};  ///< The end of the spine to which a joint is
                                                ///< attached.
  std::array<bool, kJointCount> trunk{};
};

const Hanging& hanging() {
  static const auto kHanging = [] {
    Hanging hanging;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      auto id = static_cast<JointId>(j);
      hanging.trunk[j] = in_trunk(id);
      while (!in_trunk(id)) id = parent_of(id);
      hanging.axis[j] = index_of(id);
    }
    return hanging;
  }();
  return kHanging;
}

/// The points about which a misfit scales and turns the body.
struct Centres {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const PlacedBody& body;
  const Hanging& hanging;

  /// The point about which the joint turns; null: it does not turn.
  [[nodiscard]] const Eigen::Vector3d* axis_of(std::size_t joint) const {
    const PlacedJoint& axis = body[hanging.axis[joint]];
    return hanging.trunk[joint] || !axis.placed ? nullptr : &axis.position;
  }
};

/// Derivatives d z_j / d scale and d z_j / d turn.
Eigen::Matrix<double, 3, 2> slopes_at(std::size_t joint, const Centres& at) {
  const Eigen::Vector3d& place = at.body[joint].position;
  Eigen::Matrix<double, 3, 2> slopes = Eigen::Matrix<double, 3, 2>::Zero();
  slopes.col(0) = place - at.middle;
  if (const Eigen::Vector3d* axis = at.axis_of(joint)) {
    const Eigen::Vector3d lever = place - *axis;
    slopes.col(1) = Eigen::Vector3d(lever.z(), 0.0, -lever.x());
  }
  return slopes;
}

/// Undoes a misfit; computes the sines once for all joints.
struct Mending {
  explicit Mending(const Misfit& misfit)
      : scale(misfit.scale), sine(std::sin(misfit.turn)), cosine(std::cos(misfit.turn)) {}
  /// Turned back about +y.
  [[nodiscard]] Eigen::Vector3d back(const Eigen::Vector3d& way) const {
    return {cosine * way.x() - sine * way.z(), way.y(), sine * way.x() + cosine * way.z()};
  }
  double scale;
  double sine;
  double cosine;
};

/// The view's position of a joint, corrected for the misfit.
Eigen::Vector3d mended_at(std::size_t joint, const SeenBody& seen, const Centres& at,
                          const Mending& mending) {
  Eigen::Vector3d place = seen.place[joint];
  if (const Eigen::Vector3d* axis = at.axis_of(joint)) place = *axis + mending.back(place - *axis);
  return place - mending.scale * (at.body[joint].position - at.middle);
}

/// Angle between the line of sight and the nearest frontal direction, front or rear [rad].
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

double side_on_share(const SeenBody& seen, const Centres& at, const BodyModel& model) {
  const double span = std::max(kOff, model.turn_full - model.turn_from);
  return std::clamp((side_on(seen, at) - model.turn_from) / span, 0.0, 1.0);
}

}  // namespace

double common_turn(std::span<const Misfit> misfits, const BodyModel& model) {
  if (!(model.turn > 0)) return 0.0;
  std::optional<double> least;
  for (const Misfit& each : misfits) {
    if (!(each.turn_variance > 0)) continue;
    const double sigma = kLeastTurn + model.turn * each.side_on;
    least = std::min(sigma, least.value_or(sigma));
  }
  return least.value_or(0.0);
}

Eigen::Matrix3d turn_covariance(std::size_t joint, const PlacedBody& body, double sigma) {
  const PlacedJoint& axis = body[hanging().axis[joint]];
  if (hanging().trunk[joint] || !axis.placed) return Eigen::Matrix3d::Zero();
  const Eigen::Vector3d lever = body[joint].position - axis.position;
  const Eigen::Vector3d way = sigma * Eigen::Vector3d(lever.z(), 0.0, -lever.x());
  return way * way.transpose();
}

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
  const Centres at{*middle, body, hanging()};
  const double share = side_on_share(seen, at, model);
  const double turn = model.turn > 0 ? kLeastTurn + model.turn * share : kOff;
  const double scale = std::max(kOff, model.scale);
  const Mending mending(before);
  const Eigen::Vector2d prior(1 / (scale * scale), 1 / (turn * turn));
  Eigen::Matrix2d information = prior.asDiagonal();
  Eigen::Vector2d right = -prior.cwiseProduct(Eigen::Vector2d(before.scale, before.turn));
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!seen.has(j) || !body[j].placed) continue;
    const auto slopes = slopes_at(j, at);
    const Eigen::Vector3d off = mended_at(j, seen, at, mending) - body[j].position;
    const double distance = std::sqrt(off.dot(seen.information[j] * off));
    const bool far = model.huber > 0 && distance > model.huber;
    const Eigen::Matrix<double, 2, 3> pull =
        (far ? model.huber / distance : 1.0) * slopes.transpose() * seen.information[j];
    information += pull * slopes;
    right += pull * off;
  }
  const Eigen::Matrix2d spread = information.inverse();
  const Eigen::Vector2d more = spread * right;
  return {before.scale + more.x(), before.turn + more.y(), spread(0, 0), spread(1, 1), share};
}

std::array<Eigen::Vector3d, kJointCount> mended(const SeenBody& seen, const PlacedBody& body,
                                                const Misfit& misfit) {
  auto places = seen.place;
  const auto middle = middle_of(body);
  if (!middle) return places;
  const Centres at{*middle, body, hanging()};
  const Mending mending(misfit);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!seen.has(j) || !body[j].placed) continue;
    places[j] = mended_at(j, seen, at, mending);
  }
  return places;
}

}  // namespace chorus::fusion
