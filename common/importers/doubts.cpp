#include "common/importers/doubts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "common/base/duration.h"

namespace chorus::importers {
namespace {

using record::FrameRecording;

constexpr double kSeldom = 3.0;   // [s] between frames; no sensor is that slow
constexpr double kUpright = 0.3;  // sine of the steepest body that counts as lying

bool shows_somebody(const SensorFrame& frame) { return !frame.bodies.empty(); }

/// How far up the head is seen from the hips, as a share of their distance.
std::optional<double> rise_of(const BodyFrame& body, const Eigen::Vector3d& up) {
  const Joint& hips = body.skeleton[JointId::SpineBase];
  for (const JointId id : {JointId::Head, JointId::Neck, JointId::SpineShoulder}) {
    const Joint& head = body.skeleton[id];
    const Eigen::Vector3d along = head.position - hips.position;
    if (hips.seen() && head.seen() && along.norm() > 0.0) return up.dot(along) / along.norm();
  }
  return std::nullopt;
}

bool lies_down(const FrameRecording& recording) {
  double sum = 0.0;
  double count = 0.0;
  for (const SensorFrame& frame : recording.frames) {
    const Eigen::Vector3d up = frame.floor ? frame.floor->normal : Eigen::Vector3d::UnitY();
    for (const BodyFrame& body : frame.bodies) {
      const auto rise = rise_of(body, up);
      if (!rise) continue;
      sum += *rise;
      count += 1.0;
    }
  }
  return count > 0.0 && sum < kUpright * count;
}

std::string doubt_about(const FrameRecording& recording) {
  const auto& frames = recording.frames;
  if (frames.empty()) return {};
  if (std::ranges::none_of(frames, shows_somebody))
    return fmt::format("{}: nobody is in any of its {} frames", recording.sensor.str(),
                       frames.size());
  const double whole = seconds(frames.back().captured - frames.front().captured);
  const double step = frames.size() < 2 ? 0.0 : whole / static_cast<double>(frames.size() - 1);
  if (step > kSeldom)
    return fmt::format("{}: its frames are {:.1f} s apart; are its times in milliseconds?",
                       recording.sensor.str(), step);
  if (lies_down(recording))
    return fmt::format("{}: everybody lies or stands head down; is its y up?",
                       recording.sensor.str());
  return {};
}

}  // namespace

std::vector<std::string> doubts_about(const std::vector<FrameRecording>& recordings) {
  std::vector<std::string> doubts;
  for (const FrameRecording& recording : recordings) {
    std::string doubt = doubt_about(recording);
    if (!doubt.empty()) doubts.push_back(std::move(doubt));
  }
  return doubts;
}

std::vector<std::string> numbering_doubts(const std::vector<FrameRecording>& recordings,
                                          Timestamp start, double rate_hz) {
  const auto has_none = [](const FrameRecording& recording) { return recording.frames.empty(); };
  if (recordings.empty() || std::ranges::any_of(recordings, has_none)) return {};
  const auto by_begin = [](const FrameRecording& a, const FrameRecording& b) {
    return a.frames.front().captured < b.frames.front().captured;
  };
  const auto [first, last] = std::ranges::minmax_element(recordings, by_begin);
  const auto number = [&](const FrameRecording& recording) {
    return std::llround(seconds(recording.frames.front().captured - start) * rate_hz);
  };
  if (number(*first) == number(*last)) return {};
  const double apart =
      1e3 * seconds(last->frames.front().captured - first->frames.front().captured);
  return {
      fmt::format("{} begins with picture {}, and {} with picture {}, which is taken to be "
                  "{:.0f} ms later; if they began together, give their files the same numbers",
                  first->sensor.str(), number(*first), last->sensor.str(), number(*last), apart)};
}

}  // namespace chorus::importers
