#include "tests/bench/accuracy/exchange.h"

#include <algorithm>
#include <cmath>

#include "common/synthetic/draw.h"

namespace chorus::bench {
namespace {

constexpr std::uint64_t kExchangePurpose = 601;

double exponential(synthetic::Draw& draw, double mean) {
  return -mean * std::log(1.0 - draw.uniform());
}

Duration way(const Network& network, synthetic::Draw& draw, double extra) {
  double delay = network.least + extra + exponential(draw, network.jitter);
  const bool spikes = draw.uniform() < network.spike_share;
  if (spikes) delay += exponential(draw, network.spike);
  return from_seconds(delay);
}

}  // namespace

ClockExchange exchange_of(const Link& link, const Request& request) {
  synthetic::Draw draw{kExchangePurpose, link.seed,
                       static_cast<std::uint64_t>(request.sent.time_since_epoch().count())};
  const Timestamp receipt = request.sent + way(link.network, draw, link.network.asymmetry);
  const Timestamp answered = std::max(receipt + request.held, request.ready);
  return {request.sent, link.clock.host_time(receipt), link.clock.host_time(answered),
          answered + way(link.network, draw, 0.0)};
}

std::vector<registration::WalkTrack> with_corrected_clocks(const Workshop& workshop,
                                                           const Network& network) {
  std::vector<registration::WalkTrack> tracks = workshop.tracks;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Link link{network, workshop.clocks[i], workshop.setting.seed + i};
    ClockFilter filter;
    Timestamp free = workshop.begin;
    for (SensorFrame& frame : tracks[i].frames) {
      const ClockExchange exchange = exchange_of(link, {free, Duration{0}, frame.received});
      free = exchange.received;
      filter.add(exchange);
      const auto clock = filter.at(exchange.received);
      move_in_time(frame, correction(clock));
      frame.clock_sigma = clock_sigma(clock);
    }
  }
  return tracks;
}

std::vector<registration::WalkTrack> without_clocks(const Workshop& workshop) {
  std::vector<registration::WalkTrack> tracks = workshop.tracks;
  for (registration::WalkTrack& track : tracks) {
    for (SensorFrame& frame : track.frames) frame.clock_sigma = kUnknownClock;
  }
  return tracks;
}

}  // namespace chorus::bench
