#include "tests/bench/methods/moments.h"

#include <utility>

namespace chorus::bench {

const pipeline::Histories& Arriving::until(Timestamp instant) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const std::vector<SensorFrame>& frames = tracks_[i].frames;
    align::History& history = histories_[tracks_[i].sensor];
    while (next_[i] < frames.size() && (!history.newest() || *history.newest() < instant)) {
      SensorFrame frame = frames[next_[i]++];
      frame.received = Timestamp{};  // true time; the stamp is another clock's
      history.push(std::move(frame));
    }
  }
  return histories_;
}

void visit_moments(const std::vector<registration::WalkTrack>& tracks,
                   const Registration& registration, const Period& period,
                   const std::function<void(Moment)>& visit,
                   const pipeline::PipelineConfig& config) {
  Arriving arriving(tracks);
  pipeline::Memory memory;
  std::uint64_t sequence = 0;
  const Duration step = from_seconds(1.0 / period.rate_hz);
  for (Timestamp instant = period.begin; instant <= period.end; instant += step) {
    const Timestamp late = instant + config.align.patience + Duration(1);
    auto perceived = pipeline::perceive({instant, late, sequence++}, arriving.until(instant),
                                        registration, memory, config);
    memory = std::move(perceived.memory);
    visit({instant, std::move(perceived.people), std::move(perceived.reports)});
  }
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

}  // namespace chorus::bench
