#include "fusion-server/fusion/fuse.h"

#include <algorithm>
#include <utility>

#include "fusion-server/fusion/carry.h"

namespace chorus::fusion {

Memory::Memory(const Memory& other)
    : config_(other.config_),
      published_(other.published_),
      last_(other.last_),
      several_(other.several_),
      place_errors_(other.place_errors_),
      limbs_(other.limbs_) {
  for (const auto& [key, estimator] : other.estimators_) {
    estimators_.emplace(key, estimator->clone());
  }
}

Memory& Memory::operator=(const Memory& other) {
  if (this != &other) *this = Memory(other);
  return *this;
}

std::vector<FusedBody> Memory::fuse(const std::vector<Person>& people, const Instant& instant,
                                    const FusionConfig& config) {
  if (!(config == config_)) *this = Memory();
  config_ = config;
  std::vector<FusedBody> bodies;
  for (const Person& person : people) {
    bodies.push_back(fuse(person, instant));
    bodies.back().sides_confidence = person.sides_confidence;
  }
  return bodies;
}

FusedBody Memory::fuse(const Person& person, const Instant& instant) {
  const auto last = last_.find(person.id);
  const bool known = person.carried && last != last_.end();
  Method method = known ? last->second.method : method_for(person, config_);
  // A person who was fused from several sources a moment ago stays with the configured method while
  // one source is left.
  if (!person.carried && method == config_.method) several_[person.id] = instant.at;
  const auto several = several_.find(person.id);
  const bool recently =
      several != several_.end() && instant.at - several->second <= config_.body.carry;
  if (recently && method == Method::InverseVariance) method = config_.method;
  FusedBody body = fuse_by(method, person, instant);
  place_errors_[person.id].add(body, person, instant.sensors);
  hand_over(body, method, instant.at);
  const bool placed = std::ranges::any_of(body.skeleton.joints, &Joint::seen);
  if (!person.carried && placed) last_[person.id] = {body, instant.at, method};
  if (config_.inertial.enabled && !person.carried)
    body = limbs_[person.id].steer(std::move(body), person, instant.at, config_);
  if (!known) return body;
  const Duration unseen = instant.at - last->second.at;
  if (!placed) body = carry(last->second.body, unseen, *person.carried);
  body.carried_for = seconds(unseen);
  return body;
}

/// The person fused by this method.  Where a camera is among others, PointsAndRays attends, so that
/// it goes on from this body when that camera alone is left.
FusedBody Memory::fuse_by(Method method, const Person& person, const Instant& instant) {
  const auto by = [&](Method wanted) -> Estimator& {
    auto& estimator = estimators_[{person.id, wanted}];
    if (!estimator) estimator = begin(wanted, config_);
    return *estimator;
  };
  FusedBody body = by(method).fuse(person, instant);
  body.method = name_of(method);
  if (method != Method::PointsAndRays && std::ranges::any_of(person.views, is_of_a_camera))
    by(Method::PointsAndRays).attend(body, person, instant);
  return body;
}

/// Nobody leaps when a camera that alone placed them is joined by depth sensors, or is left of
/// them.
void Memory::hand_over(FusedBody& body, Method method, Timestamp instant) {
  constexpr Duration kJustNow = std::chrono::milliseconds(200);
  PlacedBody now;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Joint& joint = body.skeleton.joints[j];
    now[j] = {joint.position, Eigen::Matrix3d::Zero(), joint.seen()};
  }
  const bool placed = std::ranges::any_of(now, &PlacedJoint::placed);
  const auto [before, fresh] = published_.try_emplace(body.id, Published{now, instant, method, {}});
  if (fresh || !placed) return;
  Published& last = before->second;
  const bool rays = method == Method::PointsAndRays || last.method == Method::PointsAndRays;
  const Duration passed = std::max(Duration{0}, instant - last.at);
  const bool changed = rays && method != last.method && passed <= kJustNow;
  last.fade.apply(body, last.places, changed, seconds(passed));
  for (std::size_t j = 0; j < kJointCount; ++j) now[j].position = body.skeleton.joints[j].position;
  last.places = now;
  last.at = instant;
  last.method = method;
}

void Memory::forget(PersonId person) {
  std::erase_if(estimators_, [&](const auto& entry) { return entry.first.first == person; });
  last_.erase(person);
  several_.erase(person);
  place_errors_.erase(person);
  published_.erase(person);
  limbs_.erase(person);
}

void Memory::keep_only(const std::set<PersonId>& tracked) {
  std::erase_if(estimators_,
                [&](const auto& entry) { return !tracked.contains(entry.first.first); });
  std::erase_if(last_, [&](const auto& entry) { return !tracked.contains(entry.first); });
  std::erase_if(several_, [&](const auto& entry) { return !tracked.contains(entry.first); });
  std::erase_if(place_errors_, [&](const auto& entry) { return !tracked.contains(entry.first); });
  std::erase_if(published_, [&](const auto& entry) { return !tracked.contains(entry.first); });
  std::erase_if(limbs_, [&](const auto& entry) { return !tracked.contains(entry.first); });
}

FusedBody fuse(const Person& person, const std::vector<SensorId>& sensors,
               const FusionConfig& config) {
  const Method method = method_for(person, config);
  FusedBody body = begin(method, config)->fuse(person, {Timestamp{}, sensors});
  body.method = name_of(method);
  PlaceErrors().add(body, person, sensors);
  return body;
}

}  // namespace chorus::fusion
