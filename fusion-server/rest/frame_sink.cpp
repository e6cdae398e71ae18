#include "fusion-server/rest/frame_sink.h"

#include <algorithm>
#include <utility>

#include "fusion-server/fusion/prediction.h"
#include "fusion-server/rest/held_things.h"

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
  for (std::size_t i = 0; i < then.bodies.size(); ++i) {
    then.bodies[i] = fusion::predicted(newest->bodies[i], ahead);
    then.bodies[i].hands = hands_along(newest->bodies[i], then.bodies[i]);
  }
  for (HeldThing& thing : then.held) {
    const auto now_at = std::ranges::find(then.bodies, thing.holder, &FusedBody::id);
    const auto was_at = std::ranges::find(newest->bodies, thing.holder, &FusedBody::id);
    if (now_at != then.bodies.end() && was_at != newest->bodies.end())
      thing = carried_along(thing, *was_at, *now_at);
  }
  return frame_of(then);
}

resource::FramePtr FrameSink::frame_of(const Snapshot& snapshot) {
  return std::make_shared<const resource::FrameResource>(wire::to_resource(snapshot));
}

}  // namespace chorus::rest
