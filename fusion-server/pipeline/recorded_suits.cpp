#include "fusion-server/pipeline/recorded_suits.h"

#include <algorithm>
#include <utility>

namespace chorus::pipeline {
namespace {

/// Sources of one lane are recorded in batches, one later than another.
constexpr Duration kSuitsAhead = std::chrono::seconds(1);

}  // namespace

RecordedSuits::RecordedSuits(std::vector<InertialLane> lanes, const worn::WornConfig& config,
                             const std::vector<worn::Beginning>& beginnings)
    : config_(config) {
  wear_.begin_with(beginnings);
  if (!config_.enabled) return;
  for (InertialLane& lane : lanes) lanes_.push_back({std::move(lane)});
}

Result<void> RecordedSuits::read_to(Timestamp instant) {
  const Timestamp until = std::min(instant, Timestamp::max() - kSuitsAhead) + kSuitsAhead;
  for (Lane& lane : lanes_) {
    while (!lane.ended && lane.newest < until) {
      auto frame = lane.from.next();
      if (!frame) return pass(frame);
      lane.ended = !*frame;
      if (lane.ended) break;
      lane.newest = std::max(lane.newest, (*frame)->captured);
      take(std::move(**frame));
    }
  }
  return {};
}

void RecordedSuits::take(inertial::InertialFrame frame) {
  if (sources_.insert(frame.source).second) wear_.configure(config_, sources_);
  wear_.take(std::move(frame));
}

}  // namespace chorus::pipeline
