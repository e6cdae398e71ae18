#include "common/quality/sensor_tally.h"

#include <algorithm>

namespace chorus::quality {
namespace {

constexpr std::size_t kFewestClocks = 30;

template <class Entry, class Value>
double median_between(const Thinned<Entry>& entries, double from, double to, const Value& value) {
  std::vector<double> values;
  for (const Entry& each : entries.values())
    if (each.at >= from && each.at <= to) values.push_back(value(each));
  return quantile(std::move(values), 0.5);
}

/// NaN: nothing was compared between these times.
Eigen::Vector3d median_offset(const Thinned<SensorTally::Offset>& offsets, double from, double to,
                              Eigen::Vector3d SensorTally::Offset::*which) {
  Eigen::Vector3d out;
  for (int axis = 0; axis < 3; ++axis)
    out[axis] =
        median_between(offsets, from, to, [&](const auto& each) { return (each.*which)[axis]; });
  return out;
}

/// What the clock adds to a residual lies along the motion; a place that is wrong adds the same
/// `standing` offset all the time.
double median_clock(const Thinned<SensorTally::ClockError>& clocks, double from, double to,
                    const Eigen::Vector3d& standing) {
  std::size_t count = 0;
  for (const auto& each : clocks.values()) count += each.at >= from && each.at <= to ? 1U : 0U;
  if (count < kFewestClocks) return std::numeric_limits<double>::quiet_NaN();
  return median_between(clocks, from, to, [&](const SensorTally::ClockError& each) {
    return -(each.off - standing).dot(each.velocity) / each.velocity.squaredNorm();
  });
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Measured joints differ from frame to frame, if only in the last digits.
bool same_bodies(const std::vector<BodyFrame>& a, const std::vector<BodyFrame>& b) {
  return std::ranges::equal(a, b, [](const BodyFrame& one, const BodyFrame& other) {
    return std::ranges::equal(one.skeleton.joints, other.skeleton.joints,
                              [](const Joint& x, const Joint& y) {
                                return x.state == y.state && x.position == y.position;
                              });
  });
}

}  // namespace

void SensorTally::add(const SensorFrame& frame, double at) {
  if (frames == 0)
    first = at;
  else
    longest_silence = std::max(longest_silence, at - last);
  ++frames;
  last = std::max(last, at);
  lateness.add(std::chrono::duration<double>(frame.received - frame.captured).count());
  if (frame.bodies.empty()) return;
  ++with_people;
  if (has_rays_alone(frame.bodies.front().skeleton.joints)) ++rays;
  if (same_bodies(frame.bodies, before)) ++repeated;
  before = frame.bodies;
}

SensorQuality SensorTally::quality(double from, double to) const {
  SensorQuality out;
  out.frames = frames;
  if (frames > 1 && last > first) out.rate = static_cast<double>(frames - 1) / (last - first);
  if (frames > 0) out.longest_silence = std::max({longest_silence, first - from, to - last});
  out.lateness = lateness.at(0.95);
  out.sees = share(with_people, frames);
  out.rays = share(rays, with_people);
  out.repeated = share(repeated, with_people);
  out.exchanged = share(exchanged, sided);
  out.compared = residuals.seen();
  out.residual = residuals.at(0.5);
  out.residual_p90 = residuals.at(0.9);
  for (std::size_t j = 0; j < kJointCount; ++j) out.joints[j] = joints[j].at(0.5);
  for (std::size_t i = 0; i < by_distance.size(); ++i) out.by_distance[i] = by_distance[i].at(0.5);
  const double third = (to - from) / 3.0;
  out.offset_first = median_offset(offsets, from, from + third, &Offset::in_world);
  out.offset_last = median_offset(offsets, to - third, to, &Offset::in_world);
  out.offset_in_sensor = median_offset(offsets, from, to, &Offset::in_sensor);
  const Eigen::Vector3d standing = median_offset(offsets, from, to, &Offset::in_world);
  out.clock = median_clock(clocks, from, to, standing);
  out.clock_first = median_clock(clocks, from, from + third, out.offset_first);
  out.clock_last = median_clock(clocks, to - third, to, out.offset_last);
  return out;
}

}  // namespace chorus::quality
