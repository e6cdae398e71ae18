#include "common/importers/doubts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "common/base/duration.h"

namespace chorus::importers {
namespace {

using record::FrameRecording;

constexpr double kSeldom = 3.0;   // [s] between frames; no sensor is that slow
constexpr double kUpright = 0.3;  // sine of the steepest body that counts as lying
constexpr std::size_t kFewJoints = 8;

bool shows_somebody(const SensorFrame& frame) { return !frame.bodies.empty(); }

/// The direction from the hips to the head, of length 1; of rays, whose ends lie at one distance
/// from the camera, the same.
std::optional<Eigen::Vector3d> along_of(const BodyFrame& body) {
  const Joint& hips = body.skeleton[JointId::SpineBase];
  for (const JointId id : {JointId::Head, JointId::Neck, JointId::SpineShoulder}) {
    const Joint& head = body.skeleton[id];
    const Eigen::Vector3d along = head.position - hips.position;
    if (hips.given() && head.given() && along.norm() > 0.0) return along.normalized();
  }
  return std::nullopt;
}

/// The mean direction from the hips to the head, and the share of it that is up.
struct Stance {
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  double rise = 0.0;
  double count = 0.0;
};

Stance stance_in(const FrameRecording& recording) {
  Stance stance;
  for (const SensorFrame& frame : recording.frames) {
    const Eigen::Vector3d up = frame.floor ? frame.floor->normal : Eigen::Vector3d::UnitY();
    for (const BodyFrame& body : frame.bodies) {
      const auto along = along_of(body);
      if (!along) continue;
      stance.along += *along;
      stance.rise += up.dot(*along);
      stance.count += 1.0;
    }
  }
  return stance;
}

/// "" if people stand upright.
std::string lying_doubt(const FrameRecording& recording, const FileSpace& space) {
  const Stance stance = stance_in(recording);
  if (stance.count == 0.0 || stance.rise >= kUpright * stance.count) return {};
  const Eigen::Vector3d in_file = space.ours_from_file.transpose() * stance.along;
  const Eigen::Vector3d up_of_file = space.ours_from_file.transpose() * Eigen::Vector3d::UnitY();
  const UpAxis there = up_along(up_of_file);
  const UpAxis meant = up_along(in_file);
  if (there.axis == meant.axis && there.down == meant.down)
    return fmt::format("{}: everybody lies or stands head down; is --floor right?",
                       recording.sensor.str());
  return fmt::format(
      "{}: everybody lies or stands head down if {} is up; with --up {} they would stand",
      recording.sensor.str(), to_string(there), to_string(meant));
}

/// How many of our joints are anywhere in the recording.
std::size_t joints_in(const FrameRecording& recording) {
  std::array<bool, kJointCount> there{};
  for (const SensorFrame& frame : recording.frames) {
    for (const BodyFrame& body : frame.bodies) {
      for (std::size_t j = 0; j < kJointCount; ++j)
        there[j] = there[j] || body.skeleton.joints[j].given();
    }
  }
  return static_cast<std::size_t>(std::ranges::count(there, true));
}

std::string seldom_doubt(const FrameRecording& recording) {
  const auto& frames = recording.frames;
  const double whole = seconds(frames.back().captured - frames.front().captured);
  const double step = frames.size() < 2 ? 0.0 : whole / static_cast<double>(frames.size() - 1);
  if (step <= kSeldom) return {};
  return fmt::format("{}: its frames are {:.1f} s apart; are its times in milliseconds?",
                     recording.sensor.str(), step);
}

std::string few_joints_doubt(const FrameRecording& recording) {
  const std::size_t joints = joints_in(recording);
  if (joints >= kFewJoints) return {};
  return fmt::format("{}: only {} of our {} joints are in it, which is little to fuse or register",
                     recording.sensor.str(), joints, kJointCount);
}

std::vector<std::string> doubts_of_one(const FrameRecording& recording, const FileSpace& space) {
  if (recording.frames.empty()) return {};
  if (std::ranges::none_of(recording.frames, shows_somebody))
    return {fmt::format("{}: nobody is in any of its {} frames", recording.sensor.str(),
                        recording.frames.size())};
  std::vector<std::string> doubts{seldom_doubt(recording), lying_doubt(recording, space),
                                  stature_doubt(recording, space), few_joints_doubt(recording)};
  std::erase(doubts, "");
  return doubts;
}

}  // namespace

std::vector<std::string> doubts_about(const std::vector<FrameRecording>& recordings,
                                      const FileSpaces& spaces) {
  std::vector<std::string> doubts;
  for (const FrameRecording& recording : recordings) {
    const auto space = spaces.find(recording.sensor);
    const auto more = doubts_of_one(recording, space == spaces.end() ? FileSpace{} : space->second);
    doubts.insert(doubts.end(), more.begin(), more.end());
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
