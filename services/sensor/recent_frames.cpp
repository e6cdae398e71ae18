#include "services/sensor/recent_frames.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

namespace chorus::sensor_service {

void RecentFrames::add(std::uint64_t sequence, http::DocumentPtr frame) {
  const std::lock_guard lock(mutex_);
  frames_.push_back({sequence, std::move(frame)});
  while (frames_.size() > kept_) frames_.pop_front();
}

Result<http::DocumentPtr> RecentFrames::find(std::string_view sequence) const {
  const std::string where = "/frames/" + std::string(sequence);
  std::uint64_t wanted = 0;
  const char* last = sequence.data() + sequence.size();
  const auto [end, error] = std::from_chars(sequence.data(), last, wanted);
  if (error != std::errc{} || end != last) {
    return fail(ErrorCode::NotFound, where, "a frame is named by its sequence number");
  }
  const std::lock_guard lock(mutex_);
  if (frames_.empty() || wanted > frames_.back().sequence) {
    return fail(ErrorCode::NotFound, where, "there is no such frame yet; /frame is the latest one");
  }
  if (wanted < frames_.front().sequence) {
    return fail(ErrorCode::Gone, where,
                "the frame has been evicted; the oldest one kept is " +
                    std::to_string(frames_.front().sequence));
  }
  const auto found =
      std::lower_bound(frames_.begin(), frames_.end(), wanted,
                       [](const Kept& kept, std::uint64_t value) { return kept.sequence < value; });
  if (found->sequence != wanted) {
    return fail(ErrorCode::NotFound, where, "the device lost this frame; it was never captured");
  }
  return found->document;
}

}  // namespace chorus::sensor_service
