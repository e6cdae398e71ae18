#include "fusion-server/worn/first_pass.h"

#include <algorithm>

#include "common/body/located.h"

namespace chorus::worn {
namespace {

constexpr double kLook = 120.0;  // [s]: calibrations improve for 60 s, limbs rest meanwhile

}  // namespace

void FirstPass::note(const Wear& wear, const std::vector<FusedBody>& bodies, Timestamp instant) {
  for (const FusedBody& body : bodies) {
    if (const auto place = middle_of(points_of(body.skeleton)))
      seen_.try_emplace(body.id, FirstSight{instant, *place});
  }
  std::set<SensorId> worn;
  for (const Wear::Worn& each : wear.worn()) {
    sources_.insert(each.source);
    if (!each.wearer) continue;
    worn.insert(each.source);
    note_source(each, instant);
  }
  for (auto& [source, wearing] : wearings_) wearing.over = wearing.over || !worn.contains(source);
}

void FirstPass::note_source(const Wear::Worn& worn, Timestamp instant) {
  const auto seen = seen_.find(*worn.wearer);
  if (seen == seen_.end()) return;
  const auto [at, begins] = wearings_.try_emplace(worn.source);
  Wearing& wearing = at->second;
  if (begins) wearing = {{worn.source, *worn.wearer, seen->second, {}}, instant};
  wearing.over = wearing.over || wearing.beginning.wearer != *worn.wearer;
  if (wearing.over) return;
  wearing.worn_for = seconds(instant - wearing.begun);
  for (const auto& [name, calibration] : worn.sensors)
    wearing.beginning.sensors.insert_or_assign(name, calibration);
}

bool FirstPass::enough() const {
  return !sources_.empty() && std::ranges::all_of(sources_, [this](const SensorId& source) {
    const auto wearing = wearings_.find(source);
    return wearing != wearings_.end() && (wearing->second.over || wearing->second.worn_for > kLook);
  });
}

std::vector<Beginning> FirstPass::found() const {
  std::vector<Beginning> all;
  for (const auto& [source, wearing] : wearings_) {
    if (!wearing.beginning.sensors.empty()) all.push_back(wearing.beginning);
  }
  return all;
}

}  // namespace chorus::worn
