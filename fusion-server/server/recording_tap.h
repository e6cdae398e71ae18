// Passes the fusion server's data to the current recording, if there is one.
//
// It does not wait, encode or access the disk.  The recorder does that on its own thread, and
// counts what it has to drop (common/record/recorder.h).
#pragma once

#include <memory>
#include <optional>

#include "common/client/frames.h"
#include "common/service/recordings.h"
#include "common/time/clock.h"
#include "common/time/clock_estimate.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/snapshot.h"
#include "fusion-server/sink.h"

namespace chorus::server {

/// How a host's times were converted to ours, as a recording states it.
[[nodiscard]] record::ClockModel clock_model(const std::optional<ClockEstimate>& estimate);

using FrameArrival = client::Arrived<resource::FrameResource>;

/// A frame as it arrived, for a recording; `placed` is the same with its place in our time.
[[nodiscard]] record::RawFrame raw_frame(const FrameArrival& arrived, const SensorFrame& placed);

class RecordingTap final : public Sink {
 public:
  RecordingTap(service::Recordings& recordings, std::shared_ptr<const Clock> clock)
      : recordings_(recordings), clock_(std::move(clock)) {}

  [[nodiscard]] std::string_view name() const override { return "recording"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;

  /// May be called from any thread.
  void raw(record::RawFrame frame);
  void raw(record::RawOrientations orientations);
  /// Records the registration in use if it, or the recording, is new; a recording does not begin
  /// with a registration without sensors. May be called repeatedly. Call it from one thread only.
  void places(const Registration& registration);

 private:
  service::Recordings& recordings_;
  std::shared_ptr<const Clock> clock_;
  std::weak_ptr<record::Recorder> told_;
  std::uint64_t told_version_ = 0;
};

}  // namespace chorus::server
