#include "common/quality/sensor_quality.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>
#include <optional>
#include <vector>

#include "common/body/bones.h"
#include "common/quality/sensor_tally.h"

namespace chorus::quality {
namespace {

using resource::BodyResource;
using resource::FrameResource;

constexpr double kSamePerson = 0.6;      // [m] between the centres of a view and of a fused body
constexpr double kLongestBetween = 0.2;  // [s] between fused frames that are interpolated
constexpr double kMoving = 0.4;          // [m/s]; slower motion says nothing of a clock
constexpr double kWait = 2.0;            // [s] that a sensor's frame waits for the fused one
constexpr std::size_t kMostWaiting = 8'192;  // frames: of 64 sensors at 60 Hz, two seconds
constexpr std::array kCentre{JointId::SpineBase, JointId::SpineMid, JointId::SpineShoulder};
constexpr double kSides = 0.1;  // [m] a person's sides are apart by at least that, seen from there
constexpr double kFront = 0.5;  // cosine: a sensor within 60 degrees of where the chest points

double seconds_of(Duration time) { return std::chrono::duration<double>(time).count(); }

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

/// One view of a person, and the fused body that it belongs to.
struct Compared {
  const SensorFrame& frame;
  const BodyFrame& view;
  const Between& fused;
  const Eigen::Isometry3d& world_from_sensor;
  const FrameResource& later;
};

/// Whether the view fits better with left and right exchanged; none: the sides are too close to one
/// another as seen, or too few are.
std::optional<bool> fits_exchanged(const Compared& what) {
  double as_it_is = 0.0;
  double exchanged = 0.0;
  double apart = 0.0;
  for (const auto& [left, right] : kMirrorPairs) {
    const auto there_left = what.fused.place(left);
    const auto there_right = what.fused.place(right);
    const Joint& l = what.view.skeleton[left];
    const Joint& r = what.view.skeleton[right];
    if (!there_left || !there_right || !l.seen() || !r.seen()) continue;
    const Eigen::Vector3d seen_left = what.world_from_sensor * l.position;
    const Eigen::Vector3d seen_right = what.world_from_sensor * r.position;
    as_it_is += (seen_left - *there_left).squaredNorm() + (seen_right - *there_right).squaredNorm();
    exchanged +=
        (seen_left - *there_right).squaredNorm() + (seen_right - *there_left).squaredNorm();
    apart = std::max(
        apart, std::min((seen_left - seen_right).norm(), (*there_left - *there_right).norm()));
  }
  if (apart < kSides) return std::nullopt;
  return exchanged < as_it_is;
}

/// Whether the sensor stands before the fused body, as seen from above.  Behind it sensors take a
/// back for a front, which says nothing of a mirrored picture.
bool sees_the_front(const Compared& what) {
  const auto left = what.fused.place(JointId::ShoulderLeft);
  const auto right = what.fused.place(JointId::ShoulderRight);
  if (!left || !right) return false;
  const Eigen::Vector3d front = (*left - *right).cross(Eigen::Vector3d::UnitY());
  Eigen::Vector3d there = what.world_from_sensor.translation() - 0.5 * (*left + *right);
  there.y() = 0.0;
  return front.dot(there) > kFront * front.norm() * there.norm();
}

}  // namespace

struct SensorJudge::Impl {
  std::map<SensorId, Eigen::Isometry3d> places;
  std::map<SensorId, SensorTally> tallies;
  std::deque<SensorFrame> waiting;
  std::optional<FrameResource> before;
  std::optional<Timestamp> origin;
  double last = 0.0;
  ViewErrors errors;
  std::vector<ViewResidual> views;

  [[nodiscard]] double time_of(Timestamp time) const {
    return origin ? seconds_of(time - *origin) : 0.0;
  }
  void take(const SensorFrame& frame, const FrameResource& a, const FrameResource& b);
  void compare(const SensorFrame& frame, const BodyFrame& view, const FrameResource& a,
               const FrameResource& b);
  void joints(const Compared& what, bool exchanged, SensorTally& tally);
  void trunk(const Compared& what, SensorTally& tally) const;
  void view_residual(const Compared& what, std::size_t joint, const Eigen::Vector3d& off);
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
  if (!best) return;
  const Compared what{frame, view, *best, place->second, b};
  SensorTally& tally = tallies[frame.sensor];
  const auto exchanged = fits_exchanged(what);
  if (exchanged && sees_the_front(what)) {
    ++tally.sided;
    tally.exchanged += *exchanged ? 1U : 0U;
  }
  joints(what, exchanged.value_or(false), tally);
  trunk(what, tally);
}

// A sensor that sees a back may name left right; its joints are compared with those they are.
void SensorJudge::Impl::joints(const Compared& what, bool exchanged, SensorTally& tally) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto id = static_cast<JointId>(j);
    const Joint& joint = what.view.skeleton[exchanged ? mirror(id) : id];
    const auto there = what.fused.place(id);
    if (joint.state != JointState::Tracked || !joint.seen() || !there) continue;
    const Eigen::Vector3d off = what.world_from_sensor * joint.position - *there;
    tally.residuals.add(off.norm());
    tally.joints[j].add(off.norm());
    tally.by_distance[distance_bin(joint.position.norm())].add(off.norm());
    view_residual(what, j, off);
  }
}

void SensorJudge::Impl::view_residual(const Compared& what, std::size_t joint,
                                      const Eigen::Vector3d& off) {
  const auto& sensors = what.later.sensors;
  const auto named = std::ranges::find(sensors, what.frame.sensor.str());
  const auto& fused = what.fused.b.joints[joint];
  if (named == sensors.end()) return;
  const auto index = static_cast<std::size_t>(named - sensors.begin());
  if (index >= kMaxSensors || (fused.contributors >> index & 1U) == 0) return;
  const bool one = std::has_single_bit(fused.contributors);
  if (!one && !fused.shares.known()) return;
  const double variance = fused.covariance.known() ? fused.covariance.matrix().trace() / 3.0
                                                   : fused.variance.value_or(0.0);
  views.push_back(
      {what.fused.b.id, joint, index, off, one ? 1.0 : fused.shares.of(index), variance});
}

void SensorJudge::Impl::trunk(const Compared& what, SensorTally& tally) const {
  Eigen::Vector3d off = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (const JointId id : kCentre) {
    const auto there = what.fused.place(id);
    if (!what.view.skeleton[id].seen() || !there) return;
    off += (what.world_from_sensor * what.view.skeleton[id].position - *there) / kCentre.size();
    velocity += what.fused.velocity(id) / kCentre.size();
  }
  const double at = time_of(what.frame.captured);
  tally.offsets.add({at, off, what.world_from_sensor.linear().transpose() * off});
  if (velocity.norm() > kMoving) tally.clocks.add({at, off, velocity});
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
  impl_->tallies[frame.sensor].add(frame, at);
  impl_->last = std::max(impl_->last, at);
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
    impl_->errors.add(impl_->views);
    impl_->views.clear();
  }
  std::erase_if(waiting, [&](const SensorFrame& frame) {
    return seconds_of(frame.captured - fused.captured) > kWait;
  });
  impl_->before = fused;
}

std::map<SensorId, SensorQuality> SensorJudge::finish() {
  std::map<SensorId, SensorQuality> out;
  double from = 0.0;
  for (const auto& [id, tally] : impl_->tallies) from = std::min(from, tally.first);
  for (const auto& [id, tally] : impl_->tallies) out[id] = tally.quality(from, impl_->last);
  return out;
}

std::array<ViewError, kJointCount> SensorJudge::view_errors() const {
  return impl_->errors.finish();
}

}  // namespace chorus::quality
