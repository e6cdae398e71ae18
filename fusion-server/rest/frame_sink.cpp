#include "fusion-server/rest/frame_sink.h"

#include <algorithm>
#include <utility>

#include "fusion-server/fusion/prediction.h"

namespace chorus::rest {

void FrameSink::publish(std::shared_ptr<const Snapshot> snapshot) {
  frames_.publish(frame_of(*snapshot));
  const std::scoped_lock lock(mutex_);
  newest_ = std::move(snapshot);
}

resource::FramePtr FrameSink::predicted(Timestamp now) const {
  std::shared_ptr<const Snapshot> newest;
  {
    const std::scoped_lock lock(mutex_);
    newest = newest_;
  }
  if (!newest) return nullptr;
  Snapshot then = *newest;
  const Duration ahead = std::clamp<Duration>(now - newest->instant, Duration{0}, kFarthest);
  then.instant += ahead;
  for (FusedBody& body : then.bodies) body = fusion::predicted(body, ahead);
  return frame_of(then);
}

resource::FramePtr FrameSink::frame_of(const Snapshot& snapshot) {
  return std::make_shared<const resource::FrameResource>(wire::to_resource(snapshot));
}

}  // namespace chorus::rest
