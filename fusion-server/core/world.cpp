#include "fusion-server/core/world.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"

namespace chorus::core {
namespace {

// If the marks of a sensor differ by more than this, it was moved [m].
constexpr double kSame = 0.3;

/// A sensor that both worlds have: its position and a point in front of it.
struct Common {
  SensorId sensor;
  std::array<Eigen::Vector3d, 2> before;
  std::array<Eigen::Vector3d, 2> after;
};

std::array<Eigen::Vector3d, 2> marks_of(const Extrinsics& place) {
  return {place.world_from_sensor.translation(),
          place.world_from_sensor * Eigen::Vector3d(0.0, 0.0, kReach)};
}

std::vector<Common> common_sensors(const Places& before, const Places& after) {
  std::vector<Common> found;
  for (const auto& [sensor, place] : before) {
    if (const auto other = after.find(sensor); other != after.end())
      found.push_back({sensor, marks_of(place), marks_of(other->second)});
  }
  return found;
}

std::optional<Eigen::Isometry3d> fit(const std::vector<Common>& sensors) {
  std::vector<Eigen::Vector3d> source;
  std::vector<Eigen::Vector3d> target;
  for (const Common& each : sensors) {
    source.insert(source.end(), each.after.begin(), each.after.end());
    target.insert(target.end(), each.before.begin(), each.before.end());
  }
  auto fitted = fit_yaw(source, target);
  if (!fitted) return std::nullopt;
  fitted->target_from_source.translation().y() = 0.0;
  return fitted->target_from_source;
}

/// Heights are ignored: both worlds have their floor at y = 0.
bool agrees(const Common& each, const Eigen::Isometry3d& before_from_after) {
  for (std::size_t i = 0; i < each.before.size(); ++i) {
    const Eigen::Vector3d apart = before_from_after * each.after[i] - each.before[i];
    if (std::hypot(apart.x(), apart.z()) > kSame) return false;
  }
  return true;
}

std::vector<Common> agreeing(const std::vector<Common>& all, const Eigen::Isometry3d& move) {
  std::vector<Common> out;
  for (const Common& each : all) {
    if (agrees(each, move)) out.push_back(each);
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

Registration in_world_of(const Places& before, Registration candidate) {
  const auto stay = unmoved(common_sensors(before, candidate.sensors), candidate.master);
  const auto before_from_candidate = fit(stay);
  if (!before_from_candidate) return candidate;
  return all_moved(std::move(candidate), *before_from_candidate);
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
  return all_moved(std::move(registration), old_from_new.inverse());
}

}  // namespace chorus::core
