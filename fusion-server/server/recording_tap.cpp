#include "fusion-server/server/recording_tap.h"

#include <utility>

#include "fusion-server/wire/registration_file.h"
#include "fusion-server/wire/snapshot_resource.h"

namespace chorus::server {

using service::Recordings;

record::ClockModel clock_model(const std::optional<ClockEstimate>& estimate) {
  record::ClockModel clock{correction(estimate), Duration{0}, {}};
  if (estimate) {
    clock.ours_minus_theirs = estimate->ours_minus_theirs;
    clock.uncertainty = estimate->uncertainty;
  }
  return clock;
}

record::RawFrame raw_frame(const FrameArrival& arrived, const SensorFrame& placed) {
  return {placed.sensor, arrived.document, placed.received, placed.floor,
          clock_model(arrived.clock)};
}

void RecordingTap::publish(std::shared_ptr<const Snapshot> snapshot) {
  const auto recorder = recordings_.recorder(Recordings::Stream::Fused);
  if (!recorder) return;
  const Timestamp instant = snapshot->instant;
  recorder->offer(record::FusedFrame{instant, clock_->now(), [snapshot = std::move(snapshot)] {
                                       return wire::to_resource(*snapshot);
                                     }});
}

void RecordingTap::raw(record::RawFrame frame) {
  if (const auto recorder = recordings_.recorder(Recordings::Stream::Raw))
    recorder->offer(std::move(frame));
}

void RecordingTap::raw(record::RawOrientations orientations) {
  if (const auto recorder = recordings_.recorder(Recordings::Stream::Raw))
    recorder->offer(std::move(orientations));
}

void RecordingTap::places(const Registration& registration) {
  const auto recorder = recordings_.recorder(Recordings::Stream::Any);
  if (!recorder) return;
  const bool known = told_.lock() == recorder;
  if (known ? told_version_ == registration.version : registration.sensors.empty()) return;
  recorder->offer(wire::places_changed(clock_->now(), registration));
  told_ = recorder;
  told_version_ = registration.version;
}

}  // namespace chorus::server
