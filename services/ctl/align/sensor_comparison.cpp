#include "services/ctl/align/sensor_comparison.h"

#include <cmath>

#include "common/alignment/marked_points.h"
#include "common/base/median.h"
#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"

namespace chorus::ctl {
namespace {

SensorMark at_rest(const std::vector<ReferenceSample>& samples) {
  SensorMark mark;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const ReferenceSample& each : samples) values.push_back(each.place[axis]);
    mark.place[axis] = median(std::move(values));
  }
  std::vector<Eigen::Quaterniond> turns;
  for (const ReferenceSample& each : samples) {
    if (each.turn) turns.push_back(*each.turn);
  }
  const std::vector<double> alike(turns.size(), 1.0);
  if (!turns.empty()) mark.turn = weighted_lerp(turns, alike);
  return mark;
}

/// Looking down is positive.
double pitch_of(const Eigen::Matrix3d& world_from_sensor) {
  return std::asin(std::clamp(-world_from_sensor(1, 2), -1.0, 1.0));
}

}  // namespace

std::map<SensorId, SensorMark> sensor_marks(const Reference& reference,
                                            const Registration& registration) {
  std::map<SensorId, SensorMark> marks;
  for (const auto& [name, samples] : reference.bodies) {
    const auto sensor = SensorId::parse(name);
    if (sensor && registration.sensors.contains(*sensor)) marks.emplace(*sensor, at_rest(samples));
  }
  return marks;
}

Result<Eigen::Isometry3d> ours_from_marks(const std::map<SensorId, SensorMark>& marks,
                                          const Registration& registration) {
  std::vector<Eigen::Vector3d> theirs;
  std::vector<Eigen::Vector3d> ours;
  double apart = 0.0;
  for (const auto& [sensor, mark] : marks) {
    theirs.push_back(mark.place);
    ours.push_back(registration.sensors.at(sensor).world_from_sensor.translation());
    const Eigen::Vector3d way = theirs.back() - theirs.front();
    apart = std::max(apart, std::hypot(way.x(), way.z()));
  }
  if (apart < alignment::kLeastApart)
    return fail(ErrorCode::NotFound, "the reference",
                "has fewer than two bodies that are called as sensors, or they stand "
                "in one place");
  const auto fit = fit_yaw(theirs, ours);
  if (!fit) return pass(fit);
  return fit->target_from_source;
}

std::vector<SensorDeviation> deviations(const std::map<SensorId, SensorMark>& marks,
                                        const Registration& registration,
                                        const Eigen::Isometry3d& ours_from_reference,
                                        bool sensor_axes) {
  std::vector<SensorDeviation> all;
  for (const auto& [sensor, mark] : marks) {
    const Eigen::Isometry3d& place = registration.sensors.at(sensor).world_from_sensor;
    const Eigen::Vector3d off = place.translation() - ours_from_reference * mark.place;
    SensorDeviation own{sensor, std::hypot(off.x(), off.z()), off.y(), {}, {}};
    if (sensor_axes && mark.turn) {
      const Eigen::Matrix3d turn = ours_from_reference.linear() * mark.turn->toRotationMatrix();
      own.yaw = wrap_angle(yaw_of(place.linear()) - yaw_of(turn));
      own.pitch = pitch_of(place.linear()) - pitch_of(turn);
    }
    all.push_back(own);
  }
  return all;
}

std::optional<Eigen::Isometry3d> by_master(const std::map<SensorId, SensorMark>& marks,
                                           const Registration& registration) {
  const auto master = marks.find(registration.master);
  if (master == marks.end() || !master->second.turn) return std::nullopt;
  const Eigen::Isometry3d& place = registration.sensors.at(master->first).world_from_sensor;
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = about_y(yaw_of(place.linear()) - yaw_of(master->second.turn->toRotationMatrix()))
                     .toRotationMatrix();
  out.translation() = place.translation() - out.linear() * master->second.place;
  return out;
}

}  // namespace chorus::ctl
