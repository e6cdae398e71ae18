#include "tests/bench/moments.h"

#include <utility>

namespace chorus::bench {

std::vector<Moment> moments_of(const std::vector<registration::WalkTrack>& tracks,
                               const Registration& registration, const Period& period,
                               const pipeline::PipelineConfig& config) {
  pipeline::Histories histories;
  std::vector<std::size_t> next(tracks.size(), 0);
  pipeline::Memory memory;
  std::vector<Moment> moments;
  const Duration step = from_seconds(1.0 / period.rate_hz);
  for (Timestamp instant = period.begin; instant <= period.end; instant += step) {
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      align::History& history = histories[tracks[i].sensor];
      while (next[i] < tracks[i].frames.size() &&
             (!history.newest() || *history.newest() < instant)) {
        SensorFrame frame = tracks[i].frames[next[i]++];
        frame.received = Timestamp{};  // true time; the stamp is another clock's
        history.push(std::move(frame));
      }
    }
    const Timestamp late = instant + config.align.patience + Duration(1);
    auto perceived = pipeline::perceive({instant, late, moments.size()}, histories, registration,
                                        memory, config);
    memory = std::move(perceived.memory);
    moments.push_back({instant, std::move(perceived.people)});
  }
  return moments;
}

}  // namespace chorus::bench
