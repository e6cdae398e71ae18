#include "fusion-server/outputs/output_bank.h"

#include <utility>

#include "common/base/log.h"

namespace chorus::outputs {

OutputBank::~OutputBank() = default;

Result<void> OutputBank::replace(std::size_t index, const OutputsConfig& config) {
  Place fresh;
  fresh.enabled = is_enabled(config, index);
  {
    Place old;
    const std::scoped_lock lock(mutex_);
    std::swap(old.sink, places_[index].sink);
  }  // `old` is destroyed after the lock: closing may wait for a thread.
  Result<void> outcome;
  if (fresh.enabled) {
    auto sink = open_output(config, index, context_);
    if (sink) {
      fresh.sink = std::move(*sink);
    } else {
      fresh.error = to_string(sink.error());
      outcome = pass(sink);
    }
  }
  const std::scoped_lock lock(mutex_);
  places_[index] = std::move(fresh);
  return outcome;
}

Result<void> OutputBank::apply(const OutputsConfig& config) {
  const std::scoped_lock one_at_a_time(applying_);
  const auto& names = output_names();
  bool first = false;
  {
    const std::scoped_lock lock(mutex_);
    first = places_.empty();
    places_.resize(names.size());
  }
  Result<void> outcome;
  for (std::size_t i = 0; i < names.size(); ++i) {
    bool failed = false;
    {
      const std::scoped_lock lock(mutex_);
      failed = !places_[i].error.empty();
    }
    // One that could not be opened is tried again: what stood in its way may be gone.
    if (!first && !failed && same_output(config_, config, i)) continue;
    auto done = replace(i, config);
    if (!first)
      log::info("output changed by a reload",
                {{"output", names[i]}, {"open", is_enabled(config, i) && done.has_value()}});
    if (!done && outcome) outcome = std::move(done);
  }
  config_ = config;
  return outcome;
}

void OutputBank::publish(std::shared_ptr<const Snapshot> snapshot) {
  const std::scoped_lock lock(mutex_);
  for (const Place& place : places_) {
    if (place.sink) place.sink->publish(snapshot);
  }
}

std::vector<OutputStatus> OutputBank::states() const {
  const std::scoped_lock lock(mutex_);
  std::vector<OutputStatus> all;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    if (!place.enabled) continue;
    all.push_back({std::string(output_names()[i]), place.error,
                   place.sink ? place.sink->counters() : SinkCounters{}});
  }
  return all;
}

}  // namespace chorus::outputs
