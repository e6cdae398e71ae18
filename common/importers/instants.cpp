#include "common/importers/instants.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/sensor/limits.h"

namespace chorus::importers {

Result<void> Instants::reach(const LineReader& at, Timestamp captured) {
  auto& frames = recording_.frames;
  if (!frames.empty() && captured < frames.back().captured)
    return at.malformed("goes back in time; rows must be in capture order.");
  if (frames.empty() || captured > frames.back().captured) {
    if (frames.size() == options_.limits.max_frames)
      return at.malformed(fmt::format("is beyond the {} frames read at most.", frames.size()));
    frames.push_back(
        {recording_.sensor, frames.size() + 1, captured, captured, {}, options_.floor});
  }
  return {};
}

Result<BodyFrame*> Instants::body(const LineReader& at, Timestamp captured, BodyId id) {
  if (auto ok = reach(at, captured); !ok) return pass(ok);
  auto& bodies = recording_.frames.back().bodies;
  const auto found = std::ranges::find(bodies, id, &BodyFrame::id);
  if (found != bodies.end()) return &*found;
  if (bodies.size() == kMaxBodies)
    return at.malformed(fmt::format("is beyond the {} bodies of a frame.", kMaxBodies));
  bodies.push_back({id, captured, {}});
  return &bodies.back();
}

}  // namespace chorus::importers
