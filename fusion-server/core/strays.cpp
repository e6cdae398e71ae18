#include "fusion-server/core/strays.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus::core {
namespace {

/// A sensor takes a reflection or a chair for a person for a shorter time than this, unless it does
/// so always.  A person also needs less time to walk through a part of the room that only one
/// sensor sees.
constexpr Duration kLongApart = std::chrono::seconds(10);
/// After a longer pause of the pipeline nothing is known of the time between.
constexpr Duration kLongestStep = std::chrono::milliseconds(500);

bool sees(const SensorId& sensor, const Person& person) {
  return std::ranges::find(person.views, sensor, &SensorView::sensor) != person.views.end();
}

std::optional<Eigen::Vector3d> place_of(const Person& person) {
  for (const SensorView& view : person.views) {
    for (const JointId id : {JointId::SpineMid, JointId::SpineBase, JointId::Neck, JointId::Head}) {
      const auto& joint = view.skeleton[id];
      if (joint.state != JointState::NotTracked && joint.position.allFinite())
        return joint.position;
    }
  }
  return std::nullopt;
}

/// Whether a sensor at this place would certainly see the person, if nothing is in between.
bool looks_at(const Extrinsics& place, const Person& person,
              const associate::AssociationConfig& config) {
  const auto there = place_of(person);
  if (!there) return false;
  const Eigen::Vector3d seen = place.world_from_sensor.inverse() * *there;
  const double distance = seen.norm();
  return distance <= config.look_range && seen.z() >= distance * std::cos(config.look_angle);
}

/// Whether some sensor that sees people looks at this one and sees nobody there.
bool missed_by_others(const Person& person, const Sights& sights,
                      const associate::AssociationConfig& config) {
  return std::ranges::any_of(sights.reports, [&](const SensorReport& report) {
    const auto place = sights.registration.sensors.find(report.sensor);
    return report.bodies > 0 && place != sights.registration.sensors.end() &&
           !sees(report.sensor, person) && looks_at(place->second, person, config);
  });
}

enum class Finding { Nothing, Together, Apart };

Finding finding_of(const SensorReport& report, const Sights& sights,
                   const associate::AssociationConfig& config) {
  const auto place = sights.registration.sensors.find(report.sensor);
  if (report.bodies == 0 || place == sights.registration.sensors.end()) return Finding::Nothing;
  bool own = false;         // this sensor alone sees somebody
  bool own_missed = false;  // whom the others should see
  bool others = false;      // others see somebody whom this one does not see
  bool missed = false;      // but should
  for (const Person& person : sights.people) {
    const bool here = sees(report.sensor, person);
    if (here && person.views.size() > 1) return Finding::Together;
    own = own || here;
    own_missed = own_missed || (here && missed_by_others(person, sights, config));
    others = others || (!here && !person.views.empty());
    missed = missed || (!here && looks_at(place->second, person, config));
  }
  const bool apart = own ? own_missed && missed : others;
  return apart ? Finding::Apart : Finding::Nothing;
}

}  // namespace

void Strays::look(const Sights& sights, const associate::AssociationConfig& config) {
  const Duration passed = last_ ? sights.instant - *last_ : Duration{0};
  const Duration step = passed > kLongestStep ? Duration{0} : std::max(passed, Duration{0});
  last_ = sights.instant;
  for (const SensorReport& report : sights.reports) {
    const Finding found = finding_of(report, sights, config);
    if (found == Finding::Together) apart_.erase(report.sensor);
    if (found == Finding::Apart)
      apart_.try_emplace(report.sensor, Apart{sights.instant}).first->second.seen += step;
  }
}

std::optional<Timestamp> Strays::since(const SensorId& sensor) const {
  const auto it = apart_.find(sensor);
  if (it == apart_.end() || it->second.seen < kLongApart) return std::nullopt;
  return it->second.since;
}

void Strays::keep(const std::set<SensorId>& sensors) {
  std::erase_if(apart_, [&](const auto& entry) { return !sensors.contains(entry.first); });
}

std::string stray_sentence(const SensorId& sensor, Timestamp since, Timestamp now) {
  return fmt::format(
      "{} has seen somebody where no other sensor does for {:.0f} s; if it was moved, run chorus "
      "register",
      sensor.str(), std::max(0.0, seconds(now - since)));
}

}  // namespace chorus::core
