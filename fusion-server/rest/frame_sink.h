// Converts snapshots to the frames that REST serves.
#pragma once

#include "common/service/frame_resources.h"
#include "fusion-server/sink.h"
#include "fusion-server/wire/snapshot_resource.h"

namespace chorus::rest {

/// `frames` must outlive the sink.
class FrameSink final : public Sink {
 public:
  explicit FrameSink(service::FrameResources& frames) : frames_(frames) {}

  [[nodiscard]] std::string_view name() const override { return "rest"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override {
    frames_.publish(frame_of(*snapshot));
  }
  /// Takes an earlier instant, fused again with the frames that came too late for it.
  void amend(const Snapshot& snapshot) { frames_.amend(frame_of(snapshot)); }

 private:
  static resource::FramePtr frame_of(const Snapshot& snapshot) {
    return std::make_shared<const resource::FrameResource>(wire::to_resource(snapshot));
  }

  service::FrameResources& frames_;
};

}  // namespace chorus::rest
