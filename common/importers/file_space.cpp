#include "common/importers/file_space.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/base/not_seen.h"
#include "common/motion/stature.h"

namespace chorus::importers {
namespace {

// Puppets and giants of animations are within this [m].
constexpr double kSmallest = 0.3;
constexpr double kLargest = 8.0;
constexpr std::size_t kEnoughBodies = 1000;

std::string told(double stature, const FileSpace& space) {
  const auto guess = motion::fitting_unit(stature, space.metres_per_unit);
  return fmt::format("people are {:.2g} m tall; with --unit {} they would be {:.2g} m", stature,
                     guess.name, stature / space.metres_per_unit * guess.metres);
}

}  // namespace

void convert(record::FrameRecording& recording, double factor, const Eigen::Matrix3d& turn) {
  const Eigen::Quaterniond rotation(turn);
  for (SensorFrame& frame : recording.frames) {
    for (BodyFrame& body : frame.bodies) {
      for (Joint& joint : body.skeleton.joints) {
        joint.position = turn * joint.position;
        if (joint.measurement == Measurement::Point) joint.position *= factor;
        joint.covariance = joint.covariance.turned(turn);
        if (joint.orientation.norm() > 0.0) joint.orientation = rotation * joint.orientation;
      }
    }
  }
}

void drop_nowhere(record::FrameRecording& recording) {
  std::size_t dropped = 0;
  for (SensorFrame& frame : recording.frames) {
    for (BodyFrame& body : frame.bodies) {
      for (Joint& joint : body.skeleton.joints) {
        if (!joint.seen() || !is_nowhere(joint.position)) continue;
        joint.state = JointState::NotTracked;
        ++dropped;
      }
    }
  }
  if (dropped > 0)
    recording.notes["unseen"] = fmt::format("{} joints at 0, 0, 0 are taken as not seen", dropped);
}

std::optional<double> median_stature(const record::FrameRecording& recording) {
  const std::size_t step = 1 + recording.frames.size() / kEnoughBodies;
  std::vector<double> statures;
  for (std::size_t f = 0; f < recording.frames.size(); f += step) {
    for (const BodyFrame& body : recording.frames[f].bodies) {
      if (const auto stature = motion::stature_of(body.skeleton)) statures.push_back(*stature);
    }
  }
  if (statures.empty()) return std::nullopt;
  return median(std::move(statures));
}

Result<void> check_stature(const record::FrameRecording& recording, const FileSpace& space) {
  const auto stature = median_stature(recording);
  if (!stature || *stature == 0.0 || (*stature >= kSmallest && *stature <= kLargest)) return {};
  const auto origin = recording.notes.find("origin");
  return fail(ErrorCode::Malformed,
              origin == recording.notes.end() ? recording.sensor.str() : origin->second,
              told(*stature, space));
}

std::string stature_doubt(const record::FrameRecording& recording, const FileSpace& space) {
  const auto stature = median_stature(recording);
  if (!stature || *stature == 0.0 || motion::is_of_a_person(*stature)) return {};
  return fmt::format("{}: {}", recording.sensor.str(), told(*stature, space));
}

}  // namespace chorus::importers
