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

/// The sensors that look at the person and see nobody there.
const std::vector<SensorId>& missing(const Person& person, const Sights& sights) {
  static const std::vector<SensorId> kNone;
  const auto found = std::ranges::find(sights.standings, person.id, &Standing::id);
  return found == sights.standings.end() ? kNone : found->missed_by;
}

/// Whether some sensor that sees people looks at this one and sees nobody there.
bool missed_by_others(const Person& person, const Sights& sights) {
  return std::ranges::any_of(missing(person, sights), [&](const SensorId& sensor) {
    const auto report = std::ranges::find(sights.reports, sensor, &SensorReport::sensor);
    return report != sights.reports.end() && report->bodies > 0;
  });
}

enum class Finding { Nothing, Together, Apart };

Finding finding_of(const SensorReport& report, const Sights& sights) {
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
    own_missed = own_missed || (here && missed_by_others(person, sights));
    others = others || (!here && !person.views.empty());
    missed = missed || std::ranges::count(missing(person, sights), report.sensor) > 0;
  }
  const bool apart = own ? own_missed && missed : others;
  return apart ? Finding::Apart : Finding::Nothing;
}

}  // namespace

void Strays::look(const Sights& sights) {
  const Duration passed = last_ ? sights.instant - *last_ : Duration{0};
  const Duration step = passed > kLongestStep ? Duration{0} : std::max(passed, Duration{0});
  last_ = sights.instant;
  for (const SensorReport& report : sights.reports) {
    const Finding found = finding_of(report, sights);
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
