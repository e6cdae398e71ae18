#include "fusion-server/pipeline/recorded_frames.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace chorus::pipeline {
namespace {

/// A frame is still used if it was recorded up to this much later than captured.
constexpr Duration kAhead = std::chrono::seconds(5);
/// Twice what 64 sensors that see 12 people each deliver in kAhead; needs about 500 MB.
constexpr std::size_t kMaxWaiting = 64 * 12 * 300;

/// What a frame adds to the memory in use, in bodies; a frame without bodies needs memory, too.
std::size_t weight_of(const SensorFrame& frame) { return 1 + frame.bodies.size(); }
constexpr std::size_t kNoLane = std::numeric_limits<std::size_t>::max();

}  // namespace

RecordedFrames::RecordedFrames(std::vector<FrameLane> lanes, const std::vector<SensorId>& sensors,
                               Registration registration)
    : registration_(std::move(registration)) {
  for (FrameLane& lane : lanes) lanes_.push_back({std::move(lane)});
  for (const SensorId& sensor : sensors) streams_[sensor].lane = kNoLane;
}

Result<void> RecordedFrames::read_one(std::size_t number) {
  Lane& lane = lanes_[number];
  auto frame = lane.from.next();
  if (!frame) return pass(frame);
  if (!*frame) {
    lane.ended = true;
    return {};
  }
  move_in_time(**frame, walked_correction(registration_, (*frame)->sensor, (*frame)->clock_sigma));
  lane.newest = std::max(lane.newest, (*frame)->captured);
  newest_ = std::max(newest_, lane.newest);
  const auto [entry, fresh] = streams_.try_emplace((*frame)->sensor);
  Stream& stream = entry->second;
  if (fresh || stream.lane == kNoLane) stream.lane = number;
  if (stream.lane != number) {
    return fail(ErrorCode::Conflict, lane.from.name,
                fmt::format("is a recording of sensor {}, and so is {}; they are not parts of one "
                            "recording: name one of them",
                            entry->first.str(), lanes_[stream.lane].from.name));
  }
  waiting_ += weight_of(**frame);
  stream.waiting.push_back(std::move(**frame));
  if (waiting_ <= kMaxWaiting) return {};
  return fail(ErrorCode::TooLarge, lane.from.name,
              "the clocks of its sensors are too far apart to be fused; record them one by one, or "
              "give their hosts the right time");
}

Result<void> RecordedFrames::read_to(Timestamp instant) {
  const Timestamp until = std::min(instant, Timestamp::max() - kAhead) + kAhead;
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    while (!lanes_[i].ended && lanes_[i].newest < until) {
      if (auto ok = read_one(i); !ok) return ok;
    }
  }
  return {};
}

std::optional<Timestamp> RecordedFrames::waiting_after(Timestamp instant) const {
  std::optional<Timestamp> earliest;
  const auto consider = [&](Timestamp captured) {
    if (captured > instant && (!earliest || captured < *earliest)) earliest = captured;
  };
  for (const auto& [sensor, stream] : streams_) {
    // The last frame played may be later than the instant itself.
    if (stream.played && *stream.played > instant) {
      consider(*stream.played);
      continue;
    }
    const auto later = std::ranges::find_if(
        stream.waiting, [&](const SensorFrame& frame) { return frame.captured > instant; });
    if (later != stream.waiting.end()) consider(later->captured);
  }
  return earliest;
}

Result<std::optional<Timestamp>> RecordedFrames::next_after(Timestamp instant) {
  auto found = waiting_after(instant);
  while (!found && !ended()) {
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      if (lanes_[i].ended) continue;
      if (auto ok = read_one(i); !ok) return pass(ok);
    }
    found = waiting_after(instant);
  }
  if (!found) return found;
  // A frame of another sensor may have been captured earlier but recorded later.
  if (auto ok = read_to(*found); !ok) return pass(ok);
  return waiting_after(instant);
}

void RecordedFrames::advance(Timestamp instant, Histories& histories) {
  for (auto& [sensor, stream] : streams_) {
    align::History& history = histories[sensor];
    while (!stream.waiting.empty() && (!history.newest() || *history.newest() < instant)) {
      SensorFrame frame = std::move(stream.waiting.front());
      stream.waiting.pop_front();
      waiting_ -= weight_of(frame);
      stream.played = frame.captured;
      // The time at which a file is read says nothing about how its frames arrived.
      frame.received = Timestamp{};
      history.push(std::move(frame));
    }
  }
}

bool RecordedFrames::ended() const {
  return std::ranges::all_of(lanes_, [](const Lane& lane) { return lane.ended; });
}

std::vector<SensorFrame> RecordedFrames::take_waiting() {
  std::vector<SensorFrame> all;
  for (auto& [sensor, stream] : streams_) {
    std::ranges::move(stream.waiting, std::back_inserter(all));
    stream.waiting.clear();
  }
  waiting_ = 0;
  return all;
}

}  // namespace chorus::pipeline
