// Converts snapshots to the frames that REST serves.
#pragma once

#include <mutex>

#include "common/service/frame_resources.h"
#include "fusion-server/sink.h"
#include "fusion-server/wire/snapshot_resource.h"

namespace chorus::rest {

/// `frames` must outlive the sink.
class FrameSink final : public Sink {
 public:
  explicit FrameSink(service::FrameResources& frames) : frames_(frames) {}

  [[nodiscard]] std::string_view name() const override { return "rest"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;
  /// Takes an earlier instant, fused again with the frames that came too late for it.
  void amend(const Snapshot& snapshot) { frames_.amend(frame_of(snapshot)); }

  /// The newest frame, predicted for `now` (fusion/prediction.h) by at most kFarthest; null before
  /// the first one.  Thread-safe.
  [[nodiscard]] resource::FramePtr predicted(Timestamp now) const;

  static constexpr Duration kFarthest = std::chrono::milliseconds(250);

 private:
  static resource::FramePtr frame_of(const Snapshot& snapshot);

  service::FrameResources& frames_;
  mutable std::mutex mutex_;
  std::shared_ptr<const Snapshot> newest_;  ///< Guarded by mutex_.
};

}  // namespace chorus::rest
