#include "fusion-server/outlet/outlet.h"

#include <exception>
#include <string>
#include <utility>

namespace chorus::outlet {
namespace {

constexpr std::size_t kWaiting = 2;
constexpr std::chrono::seconds kPatience{1};  ///< close() ends the waiting earlier.

}  // namespace

OutletSink::OutletSink(std::unique_ptr<Outlet> outlet, OutletTiming timing)
    : outlet_(std::move(outlet)),
      timing_(std::move(timing)),
      waiting_(kWaiting),
      trouble_("output " + std::string(outlet_->name()) + " failed", log::Level::Error) {
  thread_ = std::jthread([this] { run(); });
}

OutletSink::~OutletSink() { waiting_.close(); }

void OutletSink::publish(std::shared_ptr<const Snapshot> snapshot) {
  waiting_.give(std::move(snapshot));
}

SinkCounters OutletSink::counters() const {
  SinkCounters counters = outlet_->counters();
  counters.frames = sent_;
  counters.failed += failed_;
  if (failed_ > 0) counters.last_failure = trouble_.last();
  counters.dropped += waiting_.dropped();
  return counters;
}

void OutletSink::run() {
  TrackerState state(timing_.slots, timing_.board);
  while (!waiting_.closed()) {
    for (const auto& snapshot : waiting_.take(kPatience)) {
      try {
        send(state, *snapshot);
      } catch (const std::exception& thrown) {
        ++failed_;
        trouble_.hit(thrown.what());
      }
    }
  }
}

void OutletSink::send(TrackerState& state, const Snapshot& snapshot) {
  TrackerFrame frame = state.advance(snapshot);
  if (timing_.latency == Latency::Predicted) {
    frame = predicted(std::move(frame), snapshot, timing_.clock->now());
  }
  outlet_->send(frame);
  ++sent_;
}

}  // namespace chorus::outlet
