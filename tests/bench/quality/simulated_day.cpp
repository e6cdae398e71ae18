#include "tests/bench/quality/simulated_day.h"

#include <algorithm>

#include "fusion-server/pipeline/offline.h"
#include "fusion-server/wire/snapshot_resource.h"
#include "services/ctl/evaluate/recorded_quality.h"

namespace chorus::bench {
namespace {

constexpr Duration kWalk = std::chrono::seconds(30);
constexpr Duration kPublished = std::chrono::milliseconds(120);  // after the instant

Registration walked(const DaySetting& setting) {
  Setting walk = setting.work;
  walk.persons = 1;
  walk.people = {};
  walk.walk = synthetic::PathKind::Random;
  walk.length = kWalk;
  const Workshop workshop = draw_workshop(walk);
  return registration::solve(workshop.tracks, workshop.begin, {});
}

void draw_errors(Workshop& workshop, std::uint64_t seed) {
  const Setting& setting = workshop.setting;
  for (std::size_t i = 0; i < workshop.tracks.size(); ++i) {
    synthetic::SensorChoice choice{workshop.tracks[i].sensor,
                                   i,
                                   setting.profile,
                                   setting.seed,
                                   setting.stress,
                                   seed,
                                   setting.seed};
    choice.gauss.seed = seed;
    workshop.tracks[i].frames =
        synthetic::record(workshop.scene, choice, workshop.begin, workshop.begin + setting.length)
            .value();
  }
}

/// Frames of all sensors and fused ones in the order in which a recorder gets them.
void in_log_order(const Day& day, ctl::RecordedQuality& quality) {
  std::vector<const SensorFrame*> frames;
  for (const registration::WalkTrack& track : day.tracks)
    for (const SensorFrame& frame : track.frames) frames.push_back(&frame);
  std::ranges::stable_sort(frames, {}, [](const SensorFrame* frame) { return frame->received; });
  auto next = frames.begin();
  for (const resource::FrameResource& fused : day.fused) {
    for (; next != frames.end() && (*next)->received <= fused.captured + kPublished; ++next)
      quality.take(**next);
    quality.take(fused);
  }
  for (; next != frames.end(); ++next) quality.take(**next);
}

}  // namespace

Result<Day> simulated_day(const DaySetting& setting) {
  Day day;
  day.registration = walked(setting);
  day.work = draw_workshop(setting.work);
  if (setting.errors) draw_errors(day.work, *setting.errors);
  day.tracks = day.work.tracks;
  if (setting.in_views) setting.in_views(day.tracks);
  pipeline::OfflineConfig config;
  config.rate_hz = setting.rate_hz;
  const auto fused = pipeline::fuse_offline(day.tracks, day.registration, config);
  if (!fused) return pass(fused);
  for (const Snapshot& snapshot : fused->snapshots)
    day.fused.push_back(wire::to_resource(snapshot));
  if (setting.in_fused) setting.in_fused(day.fused);
  if (setting.in_registration) setting.in_registration(day.registration);
  return day;
}

quality::RecordingQuality judged(const Day& day) {
  ctl::RecordedQuality quality;
  quality.take(day.registration);
  in_log_order(day, quality);
  return quality.finish();
}

Skeleton<WorldSpace> true_body(const Day& day, std::size_t person, Timestamp at) {
  return true_body(day.work, person, at, day.registration.master);
}

}  // namespace chorus::bench
