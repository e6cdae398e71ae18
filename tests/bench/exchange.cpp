#include "tests/bench/exchange.h"

#include <cmath>

#include "common/synthetic/draw.h"

namespace chorus::bench {
namespace {

constexpr std::uint64_t kPurpose = 601;
constexpr Duration kHeld = std::chrono::milliseconds(20);  // a long poll waits for the next frame

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

poll::Exchange exchange_at(const Link& link, Timestamp answered, Duration held) {
  synthetic::Draw draw{kPurpose, link.seed,
                       static_cast<std::uint64_t>(answered.time_since_epoch().count())};
  const Timestamp receipt = answered - held;
  return {receipt - way(link.network, draw, link.network.asymmetry), link.clock.host_time(receipt),
          link.clock.host_time(answered), answered + way(link.network, draw, 0.0)};
}

std::vector<registration::WalkTrack> with_corrected_clocks(const Workshop& workshop,
                                                           const Network& network) {
  std::vector<registration::WalkTrack> tracks = workshop.tracks;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Link link{network, workshop.clocks[i], workshop.setting.seed + i};
    poll::ClockFilter filter;
    for (SensorFrame& frame : tracks[i].frames) {
      const poll::Exchange exchange = exchange_at(link, frame.received, kHeld);
      filter.add(exchange);
      frame.captured += correction(filter.at(exchange.received));
      for (BodyFrame& body : frame.bodies) body.captured = frame.captured;
    }
  }
  return tracks;
}

}  // namespace chorus::bench
