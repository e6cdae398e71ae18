#include "fusion-server/facing/sides.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::facing {
namespace {

constexpr double kGuessed = 0.3;    // weight of a pair with an inferred end
constexpr int kRounds = 3;          // agreement settles in one or two
constexpr double kShortest = 0.05;  // [m] shorter spans have no direction
constexpr std::size_t kTrunkPairs = 2;

double agreement(const Spans& a, const Spans& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// Weighted by how well the pair is seen.
Spans spans_of(const Skeleton<WorldSpace>& body) {
  Spans spans;
  spans.fill(Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < kSidePairs.size(); ++i) {
    const Joint& left = body[kSidePairs[i]];
    const Joint& right = body[mirror(kSidePairs[i])];
    if (!left.seen() || !right.seen()) continue;
    const bool tracked = left.state == JointState::Tracked && right.state == JointState::Tracked;
    spans[i] = (tracked ? 1.0 : kGuessed) * (left.position - right.position);
  }
  return spans;
}

struct Consensus {
  std::vector<double> signs;  ///< Per view; -1: against the agreed sides.
  Spans spans{};              ///< Agreed, mean over the views.
  double agreed = 0.0;
};

/// Every view joins the side it agrees with, beginning from `start`.
Consensus join(const std::vector<Spans>& views, const Spans& start) {
  Consensus consensus{std::vector<double>(views.size(), 1.0), start, 0.0};
  for (int round = 0; round < kRounds; ++round) {
    Spans sum;
    sum.fill(Eigen::Vector3d::Zero());
    consensus.agreed = 0.0;
    for (std::size_t v = 0; v < views.size(); ++v) {
      const double found = agreement(views[v], consensus.spans);
      consensus.signs[v] = found < 0 ? -1.0 : 1.0;
      consensus.agreed += std::abs(found);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += consensus.signs[v] * views[v][i];
    }
    for (Eigen::Vector3d& span : sum) span /= static_cast<double>(views.size());
    consensus.spans = sum;
  }
  return consensus;
}

/// Without memory: of all beginnings the one that ends in most agreement.
Consensus join_among_themselves(const std::vector<Spans>& views) {
  Consensus best;
  for (const Spans& start : views) {
    Consensus found = join(views, start);
    if (best.signs.empty() || found.agreed > best.agreed) best = std::move(found);
  }
  return best;
}

/// Where a body with these spans faces, horizontally; zero when that cannot be told.
Eigen::Vector3d forward_of(const Spans& spans) {
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < kTrunkPairs; ++i) left += spans[i];
  left.y() = 0;
  if (left.norm() < kShortest) return Eigen::Vector3d::Zero();
  return left.normalized().cross(Eigen::Vector3d::UnitY());
}

/// Otto's phi: how far the body faces past the sensor, in (-pi, pi]; nothing without direction.
std::optional<double> facing_of(const SensorView& view, const Eigen::Vector3d& forward) {
  const Joint& neck = view.skeleton[JointId::Neck];
  const Joint& base = view.skeleton[JointId::SpineBase];
  const Joint& stands = neck.seen() ? neck : base;
  if (!stands.seen() || forward.isZero()) return std::nullopt;
  const Eigen::Vector3d to_sensor = view.eye - stands.position;
  return wrap_angle(std::atan2(forward.x(), forward.z()) -
                    std::atan2(to_sensor.x(), to_sensor.z()));
}

/// How likely a tracker has exchanged sides of a body seen at this angle.
double exchanged_at(double facing, const SidesConfig& config) {
  const double past = (std::abs(facing) - config.exchange_at) / config.exchange_width;
  return config.exception + (1.0 - 2.0 * config.exception) / (1.0 + std::exp(-past));
}

/// Log odds of the agreed sides against the opposite ones, from where each view stands.
double odds_of_views(const Person& person, const Consensus& consensus, const SidesConfig& config) {
  const Eigen::Vector3d forward = forward_of(consensus.spans);
  double odds = 0.0;
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    const auto facing = facing_of(person.views[v], forward);
    if (!facing) continue;
    const double here = exchanged_at(*facing, config);
    const double opposite = exchanged_at(std::numbers::pi - std::abs(*facing), config);
    const bool exchanged = consensus.signs[v] < 0;
    odds += exchanged ? std::log(here / (1.0 - opposite)) : std::log((1.0 - here) / opposite);
  }
  return odds;
}

/// The same from which way the person walks.
double odds_of_walking(const Motion& motion, const Consensus& consensus,
                       const SidesConfig& config) {
  const Eigen::Vector3d way(motion.velocity.x(), 0, motion.velocity.z());
  const double speed = way.norm();
  if (!(speed >= config.walking_speed)) return 0.0;
  const double along = way.dot(forward_of(consensus.spans)) / speed;
  return along * std::log((1.0 - config.backwards) / config.backwards);
}

/// A pair nobody can tell now points where it did.
void keep_lost(Spans& spans, const Spans& before) {
  for (std::size_t i = 0; i < spans.size(); ++i) {
    if (spans[i].norm() < kShortest) spans[i] = before[i];
  }
}

/// A single view between front and rear draws its sides together and may point anywhere: what is
/// remembered follows over some frames.
Spans followed(const Spans& before, const Spans& now, double share) {
  Spans spans;
  for (std::size_t i = 0; i < spans.size(); ++i)
    spans[i] = before[i] + share * (now[i] - before[i]);
  return spans;
}

void turn_round(Consensus& consensus) {
  for (double& sign : consensus.signs) sign = -sign;
  for (Eigen::Vector3d& span : consensus.spans) span = -span;
}

void exchange(Skeleton<WorldSpace>& body) {
  for (const auto& [left, right] : kMirrorPairs) std::swap(body[left], body[right]);
  for (Joint& joint : body.joints) joint.orientation.coeffs().setZero();
}

void apply(const Consensus& consensus, Person& person) {
  const Eigen::Vector3d forward = forward_of(consensus.spans);
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    SensorView& view = person.views[v];
    if (consensus.signs[v] < 0) exchange(view.skeleton);
    if (const auto facing = facing_of(view, forward)) view.facing = *facing;
  }
}

/// What is remembered of a person, unless it is too old.
std::optional<Sides> recall(const SidesMemory& memory, PersonId person, Timestamp instant,
                            const SidesConfig& config) {
  const auto known = memory.find(person);
  if (known == memory.end()) return std::nullopt;
  const Duration age = instant - known->second.seen;
  if (age < Duration{0} || age > config.forget) return std::nullopt;
  return known->second;
}

}  // namespace

void resolve_sides(Person& person, const Motion& motion, SidesMemory& memory,
                   const SidesConfig& config) {
  if (!config.resolve || person.views.empty()) return;
  std::vector<Spans> views;
  for (const SensorView& view : person.views) views.push_back(spans_of(view.skeleton));
  const auto before = recall(memory, person.id, motion.instant, config);
  const double elapsed = before ? seconds(motion.instant - before->seen) : 0.0;
  Consensus consensus = before ? join(views, before->spans) : join_among_themselves(views);
  if (before) keep_lost(consensus.spans, before->spans);
  const double evidence =
      odds_of_views(person, consensus, config) + odds_of_walking(motion, consensus, config);
  // A first sight counts in full; later ones only as much as is new in them.
  const double share = before ? std::min(1.0, elapsed / config.memory) : 1.0;
  double odds = (before ? before->odds : 0.0) + share * evidence;
  const bool wrong = odds < -(before ? config.change_odds : 0.0);
  if (wrong) {
    turn_round(consensus);
    odds = -odds;
  }
  apply(consensus, person);
  Spans held = consensus.spans;
  if (before && !wrong) {
    held = followed(before->spans, held, elapsed / (elapsed + config.smoothing));
  }
  memory[person.id] = {motion.instant, held, std::clamp(odds, -config.most_odds, config.most_odds)};
}

}  // namespace chorus::facing
