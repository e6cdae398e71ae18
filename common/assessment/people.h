// The people of fused frames, as ergonomics takes them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/base/result.h"
#include "common/ergonomics/live.h"
#include "common/ergonomics/task.h"
#include "common/resource/frame_resource.h"

namespace chorus::assessment {

/// A body of a fused frame.  Where a joint states its variance but no covariance, it errs alike in
/// all directions.
[[nodiscard]] ergonomics::BodyAt body_at(const resource::BodyResource& body, Timestamp captured);

/// Collects the frames of a recording.
class People {
 public:
  /// Refuses frames that go back in time; takes a frame that comes twice once.
  [[nodiscard]] Result<void> add(const resource::FrameResource& frame);

  [[nodiscard]] const std::map<std::uint64_t, std::vector<ergonomics::BodyAt>>& bodies() const {
    return bodies_;
  }
  [[nodiscard]] Timestamp start() const { return start_.value_or(Timestamp{}); }
  [[nodiscard]] double seconds() const;  ///< From the first to the last frame.
  [[nodiscard]] std::size_t frames() const { return frames_; }

 private:
  std::map<std::uint64_t, std::vector<ergonomics::BodyAt>> bodies_;
  std::optional<Timestamp> start_;
  Timestamp last_{};
  std::size_t frames_ = 0;
};

/// The stance of a person: of the stretch that the task names, else found in the recording.  Errors
/// only if the task names one that is none.
[[nodiscard]] Result<std::optional<posture::Neutral>> stance_of(
    const std::vector<ergonomics::BodyAt>& bodies, const std::optional<ergonomics::Span>& stretch,
    Timestamp start);

}  // namespace chorus::assessment
