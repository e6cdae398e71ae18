// Judges a recording item by item: sensors' frames are placed and timed as the fusion server did.
#pragma once

#include <string>

#include "common/quality/quality_report.h"
#include "common/record/cell_stream.h"
#include "fusion-server/flow/registration.h"

namespace chorus::ctl {

class RecordedQuality {
 public:
  /// A registration that cannot be read is left out: fused frames can be judged without places.
  void take(const record::SessionItem& item);
  void take(const SensorFrame& frame);
  void take(const resource::FrameResource& fused);
  void take(const Registration& registration);

  [[nodiscard]] bool any_fused() const { return fused_frames_ > 0; }
  [[nodiscard]] bool any_registration() const { return registered_; }
  /// Without a name and notes.
  [[nodiscard]] quality::RecordingQuality finish();

 private:
  quality::FusedJudge fused_;
  quality::SensorJudge sensors_;
  Registration registration_;
  std::size_t fused_frames_ = 0;
  bool registered_ = false;
};

}  // namespace chorus::ctl
