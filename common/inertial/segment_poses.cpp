#include "common/inertial/segment_poses.h"

#include <algorithm>
#include <cmath>

namespace chorus::inertial {

Result<Eigen::Quaterniond> sent_rotation(std::string_view segment, const Eigen::Quaterniond& sent) {
  constexpr double kTolerance = 0.05;  // of numbers that were sent with two digits
  const double norm = sent.coeffs().norm();
  if (!(std::abs(norm - 1.0) <= kTolerance))
    return fail(ErrorCode::Malformed, "segment " + std::string(segment.substr(0, kMaxSensorName)),
                "its rotation is not of unit length");
  return Eigen::Quaterniond(Eigen::Vector4d(sent.coeffs() / norm));
}

Eigen::Quaterniond from_unity(const Eigen::Quaterniond& in_unity) {
  return {in_unity.w(), -in_unity.x(), -in_unity.y(), in_unity.z()};
}

SegmentPoses::SegmentPoses(std::vector<Segment> segments)
    : segments_(std::move(segments)), states_(segments_.size()) {}

void SegmentPoses::turn(std::size_t segment, const Eigen::Quaterniond& in_parent, Timestamp now) {
  if (states_[segment].fresh && *states_[segment].fresh != now) {
    if (auto complete = gather(turned_)) waiting_.push_back(std::move(*complete));
    if (waiting_.size() > kMostWaiting) waiting_.pop_front();
  }
  states_[segment] = {in_parent, now};
  turned_ = now;
}

std::optional<std::size_t> SegmentPoses::find(std::string_view name) const {
  const auto found = std::ranges::find(segments_, name, &Segment::name);
  if (found == segments_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - segments_.begin());
}

std::optional<InertialFrame> SegmentPoses::instant(Timestamp now) {
  if (waiting_.empty()) return gather(now);
  InertialFrame frame = std::move(waiting_.front());
  waiting_.pop_front();
  return frame;
}

std::optional<InertialFrame> SegmentPoses::gather(Timestamp now) {
  InertialFrame frame;
  std::vector<Eigen::Quaterniond> in_world(segments_.size());
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const int parent = segments_[i].parent;
    in_world[i] = parent < 0 ? states_[i].in_parent
                             : in_world[static_cast<std::size_t>(parent)] * states_[i].in_parent;
    if (segments_[i].limb && states_[i].fresh) {
      InertialReading& reading = frame.readings.emplace_back();
      reading.sensor = segments_[i].name;
      reading.captured = *states_[i].fresh;
      reading.limb = segments_[i].limb;
      reading.inertial_from_sensor = in_world[i].normalized();
    }
    states_[i].fresh.reset();
  }
  if (frame.readings.empty()) return std::nullopt;
  frame.sequence = ++instants_;
  frame.captured = now;
  return frame;
}

}  // namespace chorus::inertial
