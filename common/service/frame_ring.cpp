#include "common/service/frame_ring.h"

#include <algorithm>

#include "common/base/parse.h"
#include "common/resource/frame_between.h"

namespace chorus::service {
namespace {

/// What to say about a number with a point, as programs write seconds; empty if it is none.
std::string instant_in_seconds(const std::string& text) {
  const auto value = parse_number<double>(text);
  if (!value) return {};
  return "looks like seconds since 1970; give nanoseconds, a whole number: " +
         std::to_string(static_cast<long long>(std::clamp(*value, -9e9, 9e9) * 1e9));
}

Result<Timestamp> parse_instant(const std::string& text) {
  const auto ns = parse_number<std::int64_t>(text);
  const std::string hint = ns ? "" : instant_in_seconds(text);
  // No frame is of the first days of 1970; small numbers are seconds or milliseconds.
  constexpr std::int64_t kLeast = 1'000'000'000'000'000;
  if (ns && *ns > -kLeast && *ns < kLeast)
    return fail(ErrorCode::InvalidArgument, "/frame?at=" + text,
                "is in nanoseconds since 1970, which would be in that year; in seconds or "
                "milliseconds? Multiply by 1000000000 or 1000000");
  if (ns) return from_unix_ns(*ns);
  auto parsed = parse_iso8601(text);
  if (parsed) return parsed;
  if (!hint.empty()) return fail(ErrorCode::InvalidArgument, "/frame?at=" + text, hint);
  return fail(ErrorCode::InvalidArgument, "/frame?at=" + text,
              "give the instant as UTC, 2026-11-21T07:30:00.25Z, or in nanoseconds since 1970");
}

}  // namespace

void FrameRing::push(FramePtr frame) {
  const std::scoped_lock lock(mutex_);
  if (!frames_.empty() && frame->captured <= frames_.back().first->captured) frames_.clear();
  const Timestamp oldest = frame->captured - history_.span;
  frames_.push_back({frame, frame});
  while (frames_.size() > history_.most || frames_.front().first->captured <= oldest) {
    frames_.pop_front();
  }
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

Result<FramePtr> FrameRing::find(std::string_view sequence) const {
  const std::string where = "/frames/" + std::string(sequence);
  const auto wanted = parse_name_number(sequence);
  if (!wanted) {
    return fail(ErrorCode::NotFound, where, "a frame is named by its sequence number");
  }
  const std::scoped_lock lock(mutex_);
  const auto it = std::lower_bound(
      frames_.begin(), frames_.end(), *wanted,
      [](const Kept& kept, std::uint64_t number) { return kept.first->sequence < number; });
  if (it == frames_.end()) {
    return fail(ErrorCode::NotFound, where, "there is no such frame yet; /frame is the latest one");
  }
  if (it->first->sequence == *wanted) return it->first;
  if (it != frames_.begin()) {
    return fail(ErrorCode::NotFound, where, "no frame has this number; it was lost or left out");
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
    return fail(ErrorCode::NotFound, "/frame?at=" + time, "there is no frame of this instant yet");
  }
  if (after->first->captured == *instant) return after->better;
  if (after == frames_.begin()) {
    return fail(ErrorCode::Gone, "/frame?at=" + time,
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
