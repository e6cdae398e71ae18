// Passes the fusion server's data to the recording in progress, if there is one.
//
// It does not wait, encode or access the disk: the recorder does that on its own thread, and counts
// what it had to drop (common/record/recorder.h).
#pragma once

#include <memory>

#include "common/service/recordings.h"
#include "common/time/clock.h"
#include "fusion-server/flow.h"
#include "fusion-server/sink.h"

namespace chorus::server {

class RecordingTap final : public Sink {
 public:
  RecordingTap(service::Recordings& recordings, std::shared_ptr<const Clock> clock)
      : recordings_(recordings), clock_(std::move(clock)) {}

  [[nodiscard]] std::string_view name() const override { return "recording"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;

  /// May be called from any thread.
  void raw(record::RawFrame frame);
  /// The registration in use; may be told repeatedly, and is recorded when it or the recording is
  /// new. One thread.
  void places(const Registration& registration);

 private:
  service::Recordings& recordings_;
  std::shared_ptr<const Clock> clock_;
  std::weak_ptr<record::Recorder> told_;
  std::uint64_t told_version_ = 0;
};

}  // namespace chorus::server
