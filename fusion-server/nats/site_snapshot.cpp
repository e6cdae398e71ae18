#include "fusion-server/nats/site_snapshot.h"

#include <algorithm>
#include <set>
#include <utility>

#include "common/base/fnv.h"
#include "common/geometry/rotation.h"
#include "common/sensor/limits.h"

namespace chorus::nats {
namespace {

constexpr Duration kKeepSeat = std::chrono::seconds(10);

/// Bit of the cell in contributors; cells beyond the 64th have none.
std::uint64_t bit_of(const std::vector<SensorId>& cells, const site::CellId& cell) {
  const auto found = std::ranges::find(cells, cell);
  return found == cells.end() ? 0 : std::uint64_t{1} << (found - cells.begin());
}

/// The body moved from the cell's world into the site's space.
void move_by(const Eigen::Isometry3d& site_from_cell, FusedBody& body) {
  const Eigen::Matrix3d rotation = site_from_cell.linear();
  const Eigen::Quaterniond turn(rotation);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint& joint = body.skeleton.joints[i];
    if (joint.state == JointState::NotTracked) continue;
    joint.position = site_from_cell * joint.position;
    if (is_unit(joint.orientation)) joint.orientation = turn * joint.orientation;
    if (joint.covariance.known()) joint.covariance = joint.covariance.turned(rotation);
    Covariance& turned = body.orientation_covariance[i];
    if (turned.known()) turned = turned.turned(rotation);
    if (body.motion) (*body.motion)[i].velocity = rotation * (*body.motion)[i].velocity;
  }
  if (!body.hands) return;
  Hands hands = *body.hands;
  for (auto* hand : {&hands.left, &hands.right})
    if (*hand) *hand = moved(site_from_cell, **hand);
  body.hands = shared(std::move(hands));
}

/// What another cell told of a person: joints without orientations.
FusedBody told_body(const site::SitePerson& person) {
  FusedBody body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!person.joints[i]) continue;
    Joint& joint = body.skeleton.joints[i];
    joint.position = *person.joints[i];
    joint.state = JointState::Tracked;
  }
  const double variance = person.covariance.trace() / 3.0;
  body.variance.fill(variance);
  if (variance > 0.0) body.skeleton[JointId::SpineBase].covariance = Covariance(person.covariance);
  return body;
}

FusedBody body_of(const SiteScene& scene, const site::SitePerson& person, const Snapshot& cell) {
  const auto own = std::ranges::find(cell.bodies, person.body, &FusedBody::id);
  if (person.cell != scene.own || !scene.place || own == cell.bodies.end())
    return told_body(person);
  FusedBody body = *own;
  move_by(scene.place->site_from_cell, body);
  // Sensors and worn sources are the cell's own matter.
  body.shares = {};
  body.worn_sources.clear();
  body.worn_contributors = {};
  body.worn_share = {};
  return body;
}

/// From what its cell told to what is shown.
void move_on(const site::ShownPerson& shown, FusedBody& body) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint& joint = body.skeleton.joints[i];
    if (joint.state == JointState::NotTracked) continue;
    joint.position += shown.moved[i];
    if (joint.covariance.known())
      joint.covariance = Covariance(Eigen::Matrix3d(joint.covariance.matrix() + shown.doubt));
    body.variance[i] += shown.doubt.trace() / 3.0;
  }
}

std::vector<SensorId> cells_of(std::span<const site::ShownPerson> people) {
  std::set<SensorId> cells;
  for (const site::ShownPerson& person : people) cells.insert(person.told.cell);
  std::vector<SensorId> all(cells.begin(), cells.end());
  if (all.size() > kMaxSensors) all.resize(kMaxSensors);
  return all;
}

}  // namespace

PersonId number_of(const site::SiteId& id) {
  constexpr std::uint64_t kMost = (std::uint64_t{1} << 52U) - 1;
  return PersonId{std::max<std::uint64_t>(1, fnv1a(id.str()) & kMost)};
}

std::size_t SiteSeats::seat(const site::SiteId& id, Timestamp now) {
  std::erase_if(taken_, [now](const auto& each) { return now - each.second.last > kKeepSeat; });
  const auto found = taken_.find(id);
  if (found != taken_.end()) {
    found->second.last = now;
    return found->second.number;
  }
  std::set<std::size_t> numbers;
  for (const auto& [other, seat] : taken_) numbers.insert(seat.number);
  std::size_t free = 0;
  while (numbers.contains(free)) ++free;
  taken_[id] = {free, now};
  return free;
}

Snapshot site_snapshot(const SiteScene& scene, const Snapshot& cell, SiteSeats& seats) {
  Snapshot site;
  site.sequence = scene.sequence;
  site.instant = scene.at;
  site.sensors = cells_of(scene.people);
  for (const site::ShownPerson& shown : scene.people) {
    const site::SitePerson& person = shown.told;
    FusedBody body = body_of(scene, person, cell);
    move_on(shown, body);
    body.id = number_of(person.id);
    const std::size_t seat = seats.seat(person.id, site.instant);
    body.slot = seat < kMaxBodies ? std::optional(seat) : std::nullopt;
    const std::uint64_t bit = bit_of(site.sensors, person.cell);
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const bool there = body.skeleton.joints[i].state != JointState::NotTracked;
      body.contributors[i] = there ? bit : 0;
    }
    body.age = {};
    site.bodies.push_back(std::move(body));
  }
  return site;
}

}  // namespace chorus::nats
