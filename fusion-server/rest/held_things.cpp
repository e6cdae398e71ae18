#include "fusion-server/rest/held_things.h"

#include <algorithm>
#include <utility>

namespace chorus::rest {

HeldThings::HeldThings(std::shared_ptr<const workplace::PropBoard> board)
    : board_(std::move(board)), held_(board_) {}

void HeldThings::put(Snapshot& snapshot) {
  if (board_->props().empty()) return;
  std::vector<workplace::Holder> people;
  for (const FusedBody& body : snapshot.bodies) people.push_back({body.id.value, &body.skeleton});
  const auto places = held_.follow(snapshot.instant, people);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const workplace::PropAt& at = places[i];
    if (!at.tracked || !at.pose || !at.holding.person) continue;
    const workplace::Prop& prop = board_->props()[i];
    std::vector<JointId> joints{prop.joint};
    if (prop.other) joints.push_back(*prop.other);
    snapshot.held.push_back({prop.name, PersonId{*at.holding.person}, std::move(joints),
                             at.pose->world_from_prop, at.pose->sigma, at.pose->turn_sigma});
  }
  if (!before_.empty() && snapshot.instant <= before_.back().first) before_.clear();
  before_.emplace_back(snapshot.instant, snapshot.held);
  while (before_.front().first < snapshot.instant - kKept) before_.pop_front();
}

Snapshot HeldThings::again(Snapshot snapshot) const {
  const auto found = std::ranges::find(before_, snapshot.instant,
                                       &std::pair<Timestamp, std::vector<HeldThing>>::first);
  if (found != before_.end()) snapshot.held = found->second;
  return snapshot;
}

HandsPtr hands_along(const FusedBody& then, const FusedBody& now) {
  if (!then.hands) return nullptr;
  Hands hands = *then.hands;
  const auto move = [&](std::optional<HandPoints>& hand, JointId wrist) {
    const Joint& was = then.skeleton[wrist];
    const Joint& is = now.skeleton[wrist];
    if (!hand || !was.seen() || !is.seen()) return;
    for (Eigen::Vector3d& point : hand->points) point += is.position - was.position;
  };
  move(hands.left, JointId::WristLeft);
  move(hands.right, JointId::WristRight);
  return shared(std::move(hands));
}

HeldThing carried_along(HeldThing thing, const FusedBody& then, const FusedBody& now) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const JointId id : thing.joints) {
    if (!then.skeleton[id].seen() || !now.skeleton[id].seen()) continue;
    sum += now.skeleton[id].position - then.skeleton[id].position;
    ++count;
  }
  if (count > 0.0) thing.world_from_thing.pretranslate(sum / count);
  return thing;
}

}  // namespace chorus::rest
