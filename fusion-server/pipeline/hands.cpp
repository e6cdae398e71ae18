#include "fusion-server/pipeline/hands.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

#include "common/body/bones.h"
#include "common/body/located.h"

namespace chorus::pipeline {
namespace {

/// Farthest that a hand may be from the middle of its person [m]: arms of 0.8 m, and half a trunk.
constexpr double kArmReach = 1.2;

using ViewKey = std::pair<SensorId, BodyId>;

bool is_lone_hand(const BodyFrame& body) {
  return body.hands &&
         std::ranges::none_of(kCoreJoints, [&](JointId id) { return body.skeleton[id].given(); });
}

/// The better one for a wrist: least variance, then nearest.
struct Bid {
  double variance = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::infinity();
  const HandPoints* hand = nullptr;

  bool operator<(const Bid& other) const {
    return std::pair(variance, distance) < std::pair(other.variance, other.distance);
  }
};

struct Owner {
  std::size_t body = 0;
  double distance = std::numeric_limits<double>::infinity();
};

Owner nearest(const SeenHand& hand, const std::vector<FusedBody>& bodies) {
  const JointId id = hand.left ? JointId::WristLeft : JointId::WristRight;
  Owner best;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Joint& wrist = bodies[i].skeleton[id];
    if (!wrist.seen() || bodies[i].carried_for) continue;
    const double distance = (wrist.position - hand.hand.wrist()).norm();
    if (distance < best.distance) best = {i, distance};
  }
  return best;
}

}  // namespace

std::vector<SeenHand> hands_in_world(const std::vector<AlignedSensor>& aligned,
                                     const Registration& registration) {
  std::vector<SeenHand> hands;
  for (const AlignedSensor& sensor : aligned) {
    const auto place = registration.sensors.find(sensor.sensor);
    if (place == registration.sensors.end()) continue;
    for (const BodyFrame& body : sensor.bodies) {
      if (!body.hands) continue;
      const Eigen::Isometry3d& at = place->second.world_from_sensor;
      if (body.hands->left) hands.push_back({true, moved(at, *body.hands->left)});
      if (body.hands->right) hands.push_back({false, moved(at, *body.hands->right)});
    }
  }
  return hands;
}

void leave_out_lone_hands(const std::vector<AlignedSensor>& aligned,
                          std::vector<SensorView>& views) {
  std::set<ViewKey> lone;
  for (const AlignedSensor& sensor : aligned)
    for (const BodyFrame& body : sensor.bodies)
      if (is_lone_hand(body)) lone.emplace(sensor.sensor, body.id);
  if (lone.empty()) return;
  std::vector<Eigen::Vector3d> people;
  for (const SensorView& view : views) {
    if (lone.contains({view.sensor, view.body})) continue;
    if (const auto middle = middle_of(points_of(view.skeleton))) people.push_back(*middle);
  }
  std::erase_if(views, [&](const SensorView& view) {
    const auto middle = middle_of(points_of(view.skeleton));
    return middle && lone.contains({view.sensor, view.body}) &&
           std::ranges::any_of(people, [&](const Eigen::Vector3d& person) {
             return (person - *middle).norm() < kArmReach;
           });
  });
}

void give_hands(const std::vector<SeenHand>& hands, std::vector<FusedBody>& bodies) {
  if (hands.empty()) return;
  std::vector<std::array<Bid, 2>> bids(bodies.size());
  for (const SeenHand& hand : hands) {
    const Owner owner = nearest(hand, bodies);
    if (owner.distance > kNear) continue;
    const Bid bid{hand.hand.variance.value_or(std::numeric_limits<double>::infinity()),
                  owner.distance, &hand.hand};
    Bid& best = bids[owner.body][hand.left ? 0 : 1];
    if (bid < best) best = bid;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Hands given;
    if (bids[i][0].hand != nullptr) given.left = *bids[i][0].hand;
    if (bids[i][1].hand != nullptr) given.right = *bids[i][1].hand;
    bodies[i].hands = shared(std::move(given));
  }
}

}  // namespace chorus::pipeline
