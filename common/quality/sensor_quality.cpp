#include "common/quality/sensor_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

namespace chorus::quality {
namespace {

using resource::BodyResource;
using resource::FrameResource;

constexpr double kSamePerson = 0.6;      // [m] between the centres of a view and of a fused body
constexpr double kLongestBetween = 0.2;  // [s] between fused frames that are interpolated
constexpr double kMoving = 0.4;          // [m/s]; slower motion says nothing of a clock
constexpr double kWait = 2.0;            // [s] that a sensor's frame waits for the fused one
constexpr std::size_t kMostSamples =
    200'000;  // of each kind and sensor; then every further one replaces one
constexpr std::size_t kMostWaiting = 8'192;  // frames: of 64 sensors at 60 Hz, two seconds
constexpr std::array kCentre{JointId::SpineBase, JointId::SpineMid, JointId::SpineShoulder};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double seconds_of(Duration time) { return std::chrono::duration<double>(time).count(); }

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return kNan;
  const auto place = std::min(values.size() - 1,
                              static_cast<std::size_t>(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Keeps a bounded sample of a long series: beyond the limit, each new value takes the place of one
// that is drawn by a fixed sequence.
class Sample {
 public:
  void add(double value) {
    ++seen_;
    if (values_.size() < kMostSamples) return values_.push_back(value);
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    const std::size_t place = (state_ >> 16U) % seen_;
    if (place < values_.size()) values_[place] = value;
  }
  [[nodiscard]] double at(double share) const { return quantile(values_, share); }
  [[nodiscard]] std::size_t seen() const { return seen_; }

 private:
  std::vector<double> values_;
  std::size_t seen_ = 0;
  std::uint64_t state_ = 1;
};

struct Offset {
  double at;
  Eigen::Vector3d off;
};

Eigen::Vector3d median_of(const std::vector<Offset>& offsets, double from, double to) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Offset& each : offsets)
      if (each.at >= from && each.at <= to) values.push_back(each.off[axis]);
    const double value = quantile(std::move(values), 0.5);
    out[axis] = std::isfinite(value) ? value : 0.0;
  }
  return out;
}

struct Judged {
  std::size_t frames = 0;
  std::size_t with_people = 0;
  double first = 0.0;
  double last = 0.0;
  double longest_silence = 0.0;
  Sample lateness, residuals, clocks;
  std::array<Sample, 4> by_distance;
  std::vector<Offset> offsets;

  [[nodiscard]] SensorQuality quality() const;
};

SensorQuality Judged::quality() const {
  SensorQuality out;
  out.frames = frames;
  if (frames > 1 && last > first) out.rate = static_cast<double>(frames - 1) / (last - first);
  out.longest_silence = longest_silence;
  out.lateness = lateness.at(0.95);
  out.sees = frames == 0 ? 0.0 : static_cast<double>(with_people) / static_cast<double>(frames);
  out.compared = residuals.seen();
  out.residual = residuals.at(0.5);
  out.residual_p90 = residuals.at(0.9);
  out.clock = clocks.seen() < 30 ? kNan : clocks.at(0.5);
  for (std::size_t i = 0; i < by_distance.size(); ++i) out.by_distance[i] = by_distance[i].at(0.5);
  if (offsets.empty()) return out;
  const double from = offsets.front().at;
  const double third = (offsets.back().at - from) / 3.0;
  out.offset_first = median_of(offsets, from, from + third);
  out.offset_last = median_of(offsets, from + 2.0 * third, offsets.back().at);
  return out;
}

// A fused body between two frames, with its velocity.
struct Between {
  const BodyResource& a;
  const BodyResource& b;
  double share;
  double step;

  [[nodiscard]] std::optional<Eigen::Vector3d> place(JointId id) const {
    const auto& from = a.joints[index_of(id)];
    const auto& to = b.joints[index_of(id)];
    if (!from.seen() || !to.seen()) return std::nullopt;
    return (1.0 - share) * from.position + share * to.position;
  }
  [[nodiscard]] Eigen::Vector3d velocity(JointId id) const {
    return (b.joints[index_of(id)].position - a.joints[index_of(id)].position) / step;
  }
};

const BodyResource* body_of(const FrameResource& frame, std::uint64_t id) {
  for (const BodyResource& body : frame.bodies)
    if (body.id == id) return &body;
  return nullptr;
}

std::size_t distance_bin(double distance) {
  if (distance < 2.0) return 0;
  if (distance < 3.0) return 1;
  return distance < 4.0 ? 2 : 3;
}

}  // namespace

struct SensorJudge::Impl {
  std::map<SensorId, Eigen::Isometry3d> places;
  std::map<SensorId, Judged> judged;
  std::deque<SensorFrame> waiting;
  std::optional<FrameResource> before;
  std::optional<Timestamp> origin;

  [[nodiscard]] double time_of(Timestamp time) const {
    return origin ? seconds_of(time - *origin) : 0.0;
  }
  void take(const SensorFrame& frame, const FrameResource& a, const FrameResource& b);
  void compare(const SensorFrame& frame, const BodyFrame& view, const FrameResource& a,
               const FrameResource& b);
  void residuals(Judged& sensor, const BodyFrame& view, const Between& fused,
                 const Eigen::Isometry3d& world_from_sensor);
};

void SensorJudge::Impl::take(const SensorFrame& frame, const FrameResource& a,
                             const FrameResource& b) {
  if (seconds_of(b.captured - a.captured) > kLongestBetween) return;
  for (const BodyFrame& view : frame.bodies) compare(frame, view, a, b);
}

void SensorJudge::Impl::compare(const SensorFrame& frame, const BodyFrame& view,
                                const FrameResource& a, const FrameResource& b) {
  const auto place = places.find(frame.sensor);
  const Joint& centre = view.skeleton[JointId::SpineBase];
  if (place == places.end() || !centre.seen()) return;
  const double step = seconds_of(b.captured - a.captured);
  const double share = std::clamp(seconds_of(frame.captured - a.captured) / step, 0.0, 1.0);
  const Eigen::Vector3d x_in_world = place->second * centre.position;
  double nearest = kSamePerson;
  std::optional<Between> best;
  for (const BodyResource& body : a.bodies) {
    const BodyResource* later = body_of(b, body.id);
    if (later == nullptr || body.carried_for || later->carried_for) continue;
    const Between between{body, *later, share, step};
    const auto at = between.place(JointId::SpineBase);
    if (!at || (*at - x_in_world).norm() >= nearest) continue;
    nearest = (*at - x_in_world).norm();
    best.emplace(between);
  }
  if (best) residuals(judged[frame.sensor], view, *best, place->second);
  if (best && judged[frame.sensor].offsets.size() < kMostSamples)
    judged[frame.sensor].offsets.push_back(
        {time_of(frame.captured), x_in_world - *best->place(JointId::SpineBase)});
}

void SensorJudge::Impl::residuals(Judged& sensor, const BodyFrame& view, const Between& fused,
                                  const Eigen::Isometry3d& world_from_sensor) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto id = static_cast<JointId>(j);
    const Joint& joint = view.skeleton[id];
    const auto there = fused.place(id);
    if (joint.state != JointState::Tracked || !joint.seen() || !there) continue;
    const Eigen::Vector3d off = world_from_sensor * joint.position - *there;
    sensor.residuals.add(off.norm());
    sensor.by_distance[distance_bin(joint.position.norm())].add(off.norm());
  }
  Eigen::Vector3d off = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (const JointId id : kCentre) {
    const auto there = fused.place(id);
    if (!view.skeleton[id].seen() || !there) return;
    off += (world_from_sensor * view.skeleton[id].position - *there) / kCentre.size();
    velocity += fused.velocity(id) / kCentre.size();
  }
  if (velocity.norm() > kMoving) sensor.clocks.add(-off.dot(velocity) / velocity.squaredNorm());
}

SensorJudge::SensorJudge() : impl_(std::make_unique<Impl>()) {}
SensorJudge::~SensorJudge() = default;
SensorJudge::SensorJudge(SensorJudge&&) noexcept = default;

void SensorJudge::place(std::map<SensorId, Eigen::Isometry3d> world_from_sensor) {
  impl_->places = std::move(world_from_sensor);
}

void SensorJudge::add(const SensorFrame& frame) {
  if (!impl_->origin) impl_->origin = frame.captured;
  const double at = impl_->time_of(frame.captured);
  Judged& sensor = impl_->judged[frame.sensor];
  if (sensor.frames == 0)
    sensor.first = at;
  else
    sensor.longest_silence = std::max(sensor.longest_silence, at - sensor.last);
  ++sensor.frames;
  sensor.last = std::max(sensor.last, at);
  if (!frame.bodies.empty()) ++sensor.with_people;
  sensor.lateness.add(seconds_of(frame.received - frame.captured));
  impl_->waiting.push_back(frame);
  if (impl_->waiting.size() > kMostWaiting) impl_->waiting.pop_front();
}

void SensorJudge::add(const FrameResource& fused) {
  auto& waiting = impl_->waiting;
  if (impl_->before && fused.captured > impl_->before->captured) {
    std::deque<SensorFrame> later;
    for (SensorFrame& frame : waiting) {
      if (frame.captured > fused.captured)
        later.push_back(std::move(frame));
      else if (frame.captured >= impl_->before->captured)
        impl_->take(frame, *impl_->before, fused);
    }
    waiting = std::move(later);
  }
  std::erase_if(waiting, [&](const SensorFrame& frame) {
    return seconds_of(frame.captured - fused.captured) > kWait;
  });
  impl_->before = fused;
}

std::map<SensorId, SensorQuality> SensorJudge::finish() {
  std::map<SensorId, SensorQuality> out;
  for (const auto& [id, sensor] : impl_->judged) out[id] = sensor.quality();
  return out;
}

}  // namespace chorus::quality
