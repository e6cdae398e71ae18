#include "fusion-server/core/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "common/base/median.h"
#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"

namespace chorus::core {
namespace {

// If the marks of a sensor differ by more than this, it was moved [m].
constexpr double kSame = 0.3;
constexpr double kMarkHeight = 0.5;  // [m]
// By how much sensors that were not moved are off at least, from one walk to another [m].
constexpr double kLeastUsual = 0.020;
constexpr double kMedianToUsual = 0.85;  // median of the norm of a 2-D Gaussian: 1.177 sigma
constexpr double kCutoff = 3.0;  // standard deviations; sensors that are off by more do not count

/// A sensor that both worlds have: where they put two points below and before it.  These are half a
/// metre above the floor, because the tilt between the two worlds turns about them: what is marked
/// on the floor and the waists of people then stay equally well.
struct Common {
  SensorId sensor;
  std::array<Eigen::Vector3d, 2> before;
  std::array<Eigen::Vector3d, 2> after;
};

Common marks_of(const SensorId& sensor, const Eigen::Isometry3d& before,
                const Eigen::Isometry3d& after) {
  const Eigen::Vector3d ahead = about_y(yaw_of(before.linear())) * Eigen::Vector3d(0, 0, kReach);
  Eigen::Vector3d below = before.translation();
  below.y() = kMarkHeight;
  const Eigen::Isometry3d after_from_before = after * before.inverse();
  return {sensor,
          {below, below + ahead},
          {after_from_before * below, after_from_before * (below + ahead)}};
}

std::vector<Common> common_sensors(const Anchors& before, const Registration& after) {
  std::vector<Common> found;
  for (const auto& [sensor, place] : before) {
    if (const auto other = after.sensors.find(sensor); other != after.sensors.end())
      found.push_back(marks_of(sensor, place, other->second.world_from_sensor));
  }
  return found;
}

/// `weights`: of each sensor; empty: all the same.
std::optional<Eigen::Isometry3d> fit(const std::vector<Common>& sensors,
                                     const std::vector<double>& weights = {}) {
  std::vector<Eigen::Vector3d> source;
  std::vector<Eigen::Vector3d> target;
  std::vector<double> both;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Common& each = sensors[i];
    source.insert(source.end(), each.after.begin(), each.after.end());
    target.insert(target.end(), each.before.begin(), each.before.end());
    if (!weights.empty()) both.insert(both.end(), each.before.size(), weights[i]);
  }
  auto fitted = fit_yaw(source, target, both);
  if (!fitted) return std::nullopt;
  fitted->target_from_source.translation().y() = 0.0;
  return fitted->target_from_source;
}

/// How far the worse of a sensor's marks is off.  Heights are ignored: both worlds have their floor
/// at y = 0.
double off_by(const Common& each, const Eigen::Isometry3d& before_from_after) {
  double most = 0.0;
  for (std::size_t i = 0; i < each.before.size(); ++i) {
    const Eigen::Vector3d apart = before_from_after * each.after[i] - each.before[i];
    most = std::max(most, std::hypot(apart.x(), apart.z()));
  }
  return most;
}

std::vector<Common> agreeing(const std::vector<Common>& all, const Eigen::Isometry3d& move) {
  std::vector<Common> out;
  for (const Common& each : all) {
    if (off_by(each, move) <= kSame) out.push_back(each);
  }
  return out;
}

/// The largest group of sensors with unchanged relative places; of equally large groups, the one
/// with the master.
std::vector<Common> unmoved(const std::vector<Common>& all, const SensorId& master) {
  std::vector<Common> best;
  bool with_master = false;
  for (const Common& each : all) {
    const auto alone = fit({each});
    if (!alone) continue;
    std::vector<Common> group = agreeing(all, *alone);
    const bool has_master =
        std::ranges::any_of(group, [&](const Common& member) { return member.sensor == master; });
    const bool better =
        group.size() > best.size() || (group.size() == best.size() && has_master && !with_master);
    if (!better) continue;
    best = std::move(group);
    with_master = has_master;
  }
  return best;
}

/// The fit of the one sensor that most others agree with.
std::optional<Eigen::Isometry3d> first_guess(const std::vector<Common>& group) {
  std::optional<Eigen::Isometry3d> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Common& one : group) {
    const auto alone = fit({one});
    if (!alone) continue;
    double sum = 0.0;
    for (const Common& each : group) sum += std::min(off_by(each, *alone), kSame);
    if (sum < least) {
      least = sum;
      best = alone;
    }
  }
  return best;
}

struct RobustWorld {
  Eigen::Isometry3d before_from_after = Eigen::Isometry3d::Identity();
  double usual = 0.0;  ///< Standard deviation by which the sensors are off [m].
};

/// Leaves out what does not fit, again and again, and weighs the rest alike: an unweighted fit
/// leaves the mean of all marks where it is.
std::optional<RobustWorld> fit_robustly(const std::vector<Common>& group) {
  constexpr int kRounds = 20;
  auto move = first_guess(group);
  RobustWorld out;
  for (int round = 0; move && round < kRounds; ++round) {
    std::vector<double> off;
    for (const Common& each : group) off.push_back(off_by(each, *move));
    out = {*move, std::max(kLeastUsual, kMedianToUsual * median(off))};
    for (double& value : off) value = value <= kCutoff * out.usual ? 1.0 : 0.0;
    move = fit(group, off);
  }
  if (!move) return std::nullopt;
  out.before_from_after = *move;
  return out;
}

Registration all_moved(Registration registration, const Eigen::Isometry3d& new_from_old) {
  for (auto& [sensor, place] : registration.sensors) place = moved(std::move(place), new_from_old);
  return registration;
}

}  // namespace

Extrinsics moved(Extrinsics place, const Eigen::Isometry3d& new_from_old) {
  place.world_from_sensor = new_from_old * place.world_from_sensor;
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = new_from_old.linear();
  turn.bottomRightCorner<3, 3>() = new_from_old.linear();
  place.covariance = turn * place.covariance * turn.transpose();
  return place;
}

Anchors anchors_of(const Registration& registration) {
  Anchors all = registration.anchors;
  for (const auto& [sensor, place] : registration.sensors)
    all.try_emplace(sensor, place.world_from_sensor);
  return all;
}

Registration in_world_of(const Anchors& anchors, Registration candidate) {
  const auto common = common_sensors(anchors, candidate);
  const auto world = fit_robustly(unmoved(common, candidate.master));
  if (!world) return candidate;
  candidate = all_moved(std::move(candidate), world->before_from_after);
  candidate.anchors = anchors;
  for (const Common& each : common) {
    if (off_by(each, world->before_from_after) > kCutoff * world->usual)
      candidate.anchors.erase(each.sensor);
  }
  return candidate;
}

std::optional<Eigen::Isometry3d> moved_world(const Registration& before,
                                             const Registration& after) {
  constexpr double kExact = 1e-6;  // [m], or of an entry of a rotation; files keep more digits
  std::optional<Eigen::Isometry3d> all;
  for (const auto& [sensor, place] : before.sensors) {
    const auto now = after.sensors.find(sensor);
    if (now == after.sensors.end()) continue;
    const Eigen::Isometry3d own = now->second.world_from_sensor * place.world_from_sensor.inverse();
    if (all && !own.isApprox(*all, kExact)) return std::nullopt;
    if (!all) all = own;
  }
  if (!all || all->isApprox(Eigen::Isometry3d::Identity(), kExact)) return std::nullopt;
  const Eigen::Vector3d up = all->linear() * Eigen::Vector3d::UnitY();
  // Another tilt or height is another walk.
  if (!up.isApprox(Eigen::Vector3d::UnitY(), kExact) || std::abs(all->translation().y()) > kExact)
    return std::nullopt;
  return all;
}

Result<Registration> with_origin(Registration registration, const Origin& origin) {
  const bool near = std::abs(origin.x) <= kMaxOrigin && std::abs(origin.z) <= kMaxOrigin;
  if (!near || !std::isfinite(origin.yaw))
    return fail(ErrorCode::InvalidArgument, "origin", "x and z are numbers from -1000 to 1000 [m]");
  if (registration.sensors.empty())
    return fail(ErrorCode::NotFound, "origin",
                "no sensor has a place yet; register first (chorus register)");
  Eigen::Isometry3d old_from_new = Eigen::Isometry3d::Identity();
  old_from_new.translation() = Eigen::Vector3d(origin.x, 0.0, origin.z);
  old_from_new.linear() = about_y(origin.yaw).toRotationMatrix();
  registration.anchors.clear();
  return all_moved(std::move(registration), old_from_new.inverse());
}

}  // namespace chorus::core
