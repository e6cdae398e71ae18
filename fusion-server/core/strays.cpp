#include "fusion-server/core/strays.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus::core {
namespace {

/// Longer than a reflection or a chair is taken for a person by chance, and than a person walks
/// through the part of a room that only this sensor sees.
constexpr Duration kLongApart = std::chrono::seconds(10);
/// After a longer pause of the pipeline nothing is known of the time between.
constexpr Duration kLongestStep = std::chrono::milliseconds(500);

bool has_view_of(const SensorId& sensor, const Person& person) {
  return std::ranges::find(person.views, sensor, &SensorView::sensor) != person.views.end();
}

}  // namespace

void Strays::look(const std::vector<SensorReport>& reports, const std::vector<Person>& people,
                  Timestamp instant) {
  const Duration passed = last_ ? instant - *last_ : Duration{0};
  const Duration step = passed > kLongestStep ? Duration{0} : std::max(passed, Duration{0});
  last_ = instant;
  const bool somebody =
      std::ranges::any_of(people, [](const Person& person) { return !person.views.empty(); });
  for (const SensorReport& report : reports) {
    const auto shared = [&](const Person& person) { return has_view_of(report.sensor, person); };
    if (std::ranges::any_of(people, shared)) {
      apart_.erase(report.sensor);
    } else if (report.bodies > 0 && somebody) {
      apart_.try_emplace(report.sensor, Apart{instant}).first->second.seen += step;
    }
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
      "register, else it takes a thing or a mirror image for a person",
      sensor.str(), std::max(0.0, seconds(now - since)));
}

}  // namespace chorus::core
