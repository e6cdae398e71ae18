#include "common/service/frame_ring.h"

#include <algorithm>
#include <charconv>

#include "common/resource/frame_between.h"

namespace chorus::service {
namespace {

Result<Timestamp> parse_instant(const std::string& text) {
  std::int64_t ns = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, ns);
  if (error == std::errc{} && stop == end) return from_unix_ns(ns);
  auto parsed = parse_iso8601(text);
  if (parsed) return parsed;
  return fail(ErrorCode::InvalidArgument, "at=" + text,
              "give the instant as UTC, 2026-11-21T07:30:00.25Z, or in nanoseconds since 1970");
}

}  // namespace

void FrameRing::push(FramePtr frame) {
  const std::scoped_lock lock(mutex_);
  if (!frames_.empty() && frame->captured <= frames_.back().first->captured) frames_.clear();
  if (frames_.size() >= capacity_) frames_.pop_front();
  frames_.push_back({frame, frame});
}

void FrameRing::amend(FramePtr frame) {
  const std::scoped_lock lock(mutex_);
  const auto it = std::lower_bound(
      frames_.begin(), frames_.end(), frame->captured,
      [](const Kept& kept, Timestamp wanted) { return kept.first->captured < wanted; });
  if (it == frames_.end() || it->first->captured != frame->captured) return;
  it->better = std::move(frame);
  ++amendments_;
}

std::uint64_t FrameRing::amendments() const {
  const std::scoped_lock lock(mutex_);
  return amendments_;
}

Result<FramePtr> FrameRing::find(std::uint64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  const auto it = std::lower_bound(
      frames_.begin(), frames_.end(), sequence,
      [](const Kept& kept, std::uint64_t wanted) { return kept.first->sequence < wanted; });
  const std::string where = "frames/" + std::to_string(sequence);
  if (it == frames_.end()) {
    return fail(ErrorCode::NotFound, where,
                "there has not been a frame of this sequence number yet");
  }
  if (it->first->sequence == sequence) return it->first;
  if (it != frames_.begin()) {
    return fail(ErrorCode::NotFound, where,
                "no frame has this sequence number; its instant was left out");
  }
  return fail(ErrorCode::Gone, where,
              "the oldest frame still here is " + std::to_string(frames_.front().first->sequence));
}

Result<FramePtr> FrameRing::at(const std::string& time) const {
  const auto instant = parse_instant(time);
  if (!instant) return pass(instant);
  const std::scoped_lock lock(mutex_);
  const auto after = std::lower_bound(
      frames_.begin(), frames_.end(), *instant,
      [](const Kept& kept, Timestamp wanted) { return kept.first->captured < wanted; });
  if (after == frames_.end()) {
    return fail(ErrorCode::NotFound, "at=" + time, "this instant has not been fused yet");
  }
  if (after->first->captured == *instant) return after->better;
  if (after == frames_.begin()) {
    return fail(ErrorCode::Gone, "at=" + time,
                "the oldest instant still here is " + to_iso8601(frames_.front().first->captured));
  }
  return std::make_shared<const resource::FrameResource>(
      resource::between(*std::prev(after)->better, *after->better, *instant));
}

FramePtr FrameRing::newest() const {
  const std::scoped_lock lock(mutex_);
  return frames_.empty() ? nullptr : frames_.back().first;
}

}  // namespace chorus::service
