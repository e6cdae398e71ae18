#include "fusion-server/align/same_body.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "common/body/bones.h"

namespace chorus::align {
namespace {

constexpr double kJumpSlack = 0.1;  // By how much a body's core may jump through noise alone [m].
constexpr double kWalking = 1.5;    // [m/s]

struct Match {
  std::size_t before = 0;
  std::size_t after = 0;
  double cost = 0.0;  // [m]
};

/// Length of the mean way of the core joints that both show [m]; none where there are none.
std::optional<double> way_between(const BodyFrame& before, const BodyFrame& after) {
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const JointId id : kCoreJoints) {
    const Joint& from = before.skeleton[id];
    const Joint& to = after.skeleton[id];
    if (!from.seen() || !to.seen()) continue;
    way += to.position - from.position;
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return way.norm() / count;
}

/// All pairs that may be the same person, the best first.
std::vector<Match> matches(const SensorFrame& before, const SensorFrame& after, double max_speed) {
  const double gap = seconds(after.captured - before.captured);
  const double reach = max_speed * gap + kJumpSlack;
  const double renamed = kJumpSlack + kWalking * gap;
  std::vector<Match> found;
  for (std::size_t i = 0; i < before.bodies.size(); ++i) {
    for (std::size_t k = 0; k < after.bodies.size(); ++k) {
      const bool same_id = before.bodies[i].id == after.bodies[k].id;
      const auto way = way_between(before.bodies[i], after.bodies[k]);
      if (way ? *way > reach : !same_id) continue;
      found.push_back({i, k, way.value_or(0.0) + (same_id ? 0.0 : renamed)});
    }
  }
  std::ranges::stable_sort(found, {}, &Match::cost);
  return found;
}

}  // namespace

std::vector<BodyPair> same_bodies(const SensorFrame& before, const SensorFrame& after,
                                  double max_speed) {
  std::vector<BodyPair> pairs(before.bodies.size());
  std::vector<bool> taken(after.bodies.size(), false);
  for (const Match& match : matches(before, after, max_speed)) {
    if (pairs[match.before].first != nullptr || taken[match.after]) continue;
    pairs[match.before] = {&before.bodies[match.before], &after.bodies[match.after]};
    taken[match.after] = true;
  }
  std::erase_if(pairs, [](const BodyPair& pair) { return pair.first == nullptr; });
  return pairs;
}

}  // namespace chorus::align
