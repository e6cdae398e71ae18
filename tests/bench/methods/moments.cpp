#include "tests/bench/methods/moments.h"

#include <utility>

#include "fusion-server/pipeline/smoother.h"

namespace chorus::bench {

const pipeline::Histories& Arriving::until(Timestamp instant) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const std::vector<SensorFrame>& frames = tracks_[i].frames;
    align::History& history = histories_[tracks_[i].sensor];
    while (next_[i] < frames.size() && (!history.newest() || *history.newest() < instant)) {
      SensorFrame frame = frames[next_[i]++];
      frame.received = Timestamp{};  // it is true time, while `captured` is by the host's clock
      history.push(std::move(frame));
    }
  }
  return histories_;
}

namespace {

/// Visits the instants in order, and each of them only after all its data has arrived.
template <class Take>
void each_instant(const std::vector<registration::WalkTrack>& tracks, const Period& period,
                  const align::AlignConfig& config, const Take& take) {
  Arriving arriving(tracks);
  std::uint64_t sequence = 0;
  const Duration step = from_seconds(1.0 / period.rate_hz);
  for (Timestamp instant = period.begin; instant <= period.end; instant += step) {
    const Timestamp late = instant + config.patience + Duration(1);
    take(pipeline::Inputs{instant, late, sequence++}, arriving.until(instant));
  }
}

}  // namespace

void visit_moments(const std::vector<registration::WalkTrack>& tracks,
                   const Registration& registration, const Period& period,
                   const std::function<void(Moment)>& visit,
                   const pipeline::PipelineConfig& config) {
  pipeline::Memory memory;
  each_instant(tracks, period, config.align,
               [&](const pipeline::Inputs& in, const pipeline::Histories& histories) {
                 auto perceived = pipeline::perceive(in, histories, registration, memory, config);
                 memory = std::move(perceived.memory);
                 visit({in.instant, std::move(perceived.people), std::move(perceived.reports)});
               });
}

void visit_scenes(const std::vector<registration::WalkTrack>& tracks,
                  const Registration& registration, const Period& period,
                  const std::function<void(const associate::Scene&)>& visit) {
  const pipeline::PipelineConfig config;
  each_instant(tracks, period, config.align,
               [&](const pipeline::Inputs& in, const pipeline::Histories& histories) {
                 visit(pipeline::scene_at(in, histories, registration, config));
               });
}

std::vector<Moment> moments_of(const std::vector<registration::WalkTrack>& tracks,
                               const Registration& registration, const Period& period,
                               const pipeline::PipelineConfig& config) {
  std::vector<Moment> moments;
  visit_moments(
      tracks, registration, period, [&](Moment moment) { moments.push_back(std::move(moment)); },
      config);
  return moments;
}

std::vector<Snapshot> smoothed_moments(const std::vector<registration::WalkTrack>& tracks,
                                       const Registration& registration, const Period& period,
                                       const pipeline::PipelineConfig& config) {
  pipeline::Smoother smoother;
  pipeline::Memory memory;
  std::vector<Snapshot> snapshots;
  const auto keep = [&](std::vector<pipeline::Step> steps) {
    for (pipeline::Step& step : steps) snapshots.push_back(std::move(step.snapshot));
  };
  each_instant(tracks, period, config.align,
               [&](const pipeline::Inputs& in, const pipeline::Histories& histories) {
                 auto seen = pipeline::perceive(in, histories, registration, memory, config);
                 auto now =
                     pipeline::perception_of(in, pipeline::taking_part(registration, config), seen);
                 memory = std::move(seen.memory);
                 keep(smoother.take(std::move(now), config));
               });
  keep(smoother.finish(config));
  return snapshots;
}

}  // namespace chorus::bench
