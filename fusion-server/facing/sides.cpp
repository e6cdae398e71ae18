#include "fusion-server/facing/sides.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/body/bones.h"

namespace chorus::facing {
namespace {

constexpr double kClear = 2.0;  // Log odds above which one view alone counts as certain.
// If the sum of the views' |log odds| is less than this, no view shows left and right.
constexpr double kBlind = 1.0;
constexpr double kInNoDoubt = deg(45);  // Spans that differ by less than this have the same sign.
constexpr double kFrameTime = 0.033;    // [s]; the labels of one frame count as one observation.

/// Everything that the model computes for one person at one instant.
struct Instant {
  Timestamp at = {};
  double elapsed = 0.0;  ///< Time since the person was last seen [s].
  bool first = true;
  double upright = 1.0;  ///< See upright_share().
  double posture = 0.0;  ///< See posture_log_odds().
  double worn = 0.0;     ///< See worn_log_odds().
  std::vector<Spans> views = {};
  std::vector<double> agree = {};     ///< Log odds of each view, see agreement_log_odds().
  std::vector<bool> exchanged = {};   ///< For each view, whether it opposes the held sides.
  std::vector<LabelStep> steps = {};  ///< For each view; `exchanged` is 0.5 if unknown.
};

std::vector<Spans> all_spans(const Person& person) {
  std::vector<Spans> views;
  for (const SensorView& view : person.views) views.push_back(spans_of(view.skeleton));
  return views;
}

/// What is remembered about a person; none if it is too old.
std::optional<Sides> recall(const SidesMemory& memory, PersonId person, Timestamp instant,
                            const SidesConfig& config) {
  const auto known = memory.people.find(person);
  if (known == memory.people.end()) return std::nullopt;
  const Duration age = instant - known->second.seen;
  if (age < Duration{0} || age > config.forget) return std::nullopt;
  return known->second;
}

/// A pair whose direction is unknown at present keeps its last one.
void keep_lost(Spans& spans, const Spans& before) {
  for (std::size_t i = 0; i < spans.size(); ++i) {
    if (spans[i].norm() < kMinSpan) spans[i] = before[i];
  }
}

/// What is known of how the sensor labels people who turn their backs on it.
Telling known_of(const SensorId& sensor, const SidesMemory& memory) {
  const auto known = memory.telling.find(sensor);
  return known == memory.telling.end() ? Telling{} : known->second;
}

/// True if the view opposes the held sides.  However narrow a view is, what it shows now counts for
/// more than its last labels: a tracker that changes them draws the sides together meanwhile, and
/// two opposite sensors change them together.  A sensor that tells front from rear seldom swaps
/// left and right, so its view must show more clearly that it did.  A flat figure lacks the part of
/// its spans along the line of sight, so the last decision is kept while the figure is narrow.
bool opposes(const SensorView& view, bool flat, const Spans& spans, const Sides& sides,
             const SidesMemory& memory, const SidesConfig& config) {
  const double agree = usual_log_odds(known_of(view.sensor, memory), config.telling) +
                       shown_log_odds(spans, sides.spans);
  if (std::abs(agree) > (flat ? kClear : 0.0)) return agree < 0;
  const auto before = sides.views.find(view.sensor);
  return before != sides.views.end() && before->second.exchanged.held > 0.5;
}

void look_at_views(Instant& now, const Person& person, std::span<const Figure> flat,
                   const Sides& sides, const SidesMemory& memory, const SidesConfig& config) {
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    const bool is_flat = std::ranges::find(flat, v, &Figure::view) != flat.end();
    now.agree.push_back(agreement_log_odds(now.views[v], sides.spans));
    now.exchanged.push_back(opposes(person.views[v], is_flat, now.views[v], sides, memory, config));
  }
}

/// The mean of the views, weighted by the size of their spans; a view that opposes the held sides
/// is reversed.
Spans joined(const Instant& now) {
  Spans spans = no_spans();
  double weights = 0.0;
  for (std::size_t v = 0; v < now.views.size(); ++v) {
    const double weight = size_of(now.views[v]);
    const double sign = now.exchanged[v] ? -1.0 : 1.0;
    for (std::size_t i = 0; i < spans.size(); ++i) spans[i] += sign * weight * now.views[v][i];
    weights += weight;
  }
  if (weights > 0) {
    for (Eigen::Vector3d& span : spans) span /= weights;
  }
  return spans;
}

/// How far a view's spans can be trusted, in [0, 1].  While a tracker changes its labels, it moves
/// left and right joints towards the middle, and the spans may point anywhere.  A real body does
/// not become narrower, so spans much shorter than the held ones show no direction.
double trust_in(const Spans& now, const Spans& before) {
  // Spans this short, relative to the held ones, are not trusted at all.
  constexpr double kNone = 0.5;
  constexpr double kFull = 0.8;
  const double part = size_of(now) / std::max(size_of(before), kMinSpan);
  return std::clamp((part - kNone) / (kFull - kNone), 0.0, 1.0);
}

Spans followed(const Spans& before, const Spans& now, double share) {
  Spans spans;
  for (std::size_t i = 0; i < spans.size(); ++i)
    spans[i] = before[i] + share * (now[i] - before[i]);
  return spans;
}

/// The chance that `spans` follow the held ones with the wrong sign.  Held spans lag behind a
/// person who turns, because trackers and smoothing do; at 90 deg either sign is as likely.  For
/// nearly equal spans the chance is zero: otherwise the sides of a person who stands still would
/// become uncertain over time.
double misled(const Spans& spans, const Spans& held, double sigma) {
  const double size = size_of(spans) * size_of(held);
  if (!(size > kMinSpan * kMinSpan)) return 0.0;
  const double cosine = std::clamp(agreement(spans, held) / size, -1.0, 1.0);
  const double angle = std::acos(cosine);
  if (angle < kInNoDoubt) return 0.0;
  const double short_of_side = 0.5 * std::numbers::pi - angle;
  return 1.0 / (1.0 + std::exp(std::numbers::pi * short_of_side / (sigma * sigma)));
}

/// The chance that, since the last instant, the sides became wrong because the held spans followed
/// the views with the wrong sign.  The held spans lag behind for the whole smoothing time, so each
/// instant counts only for its part of that time.
double slipped_by_turning(const Instant& now, const Spans& spans, const Sides& sides,
                          const SidesConfig& config) {
  if (now.first) return 0.0;
  const double share = now.elapsed / std::max(config.smoothing, now.elapsed);
  return share * misled(spans, sides.spans, config.turn_sigma);
}

/// What posture or worn sensors, as log odds, tell again about sides that have slipped with this
/// chance.  What they told before was about the sides that were held then, and is forgotten with
/// them in the share of twice the chance: at a half, nothing is left of it.
double seen_anew(double slipped, double told) { return std::min(1.0, 2.0 * slipped) * told; }

/// Advances the labels of a view by one step.
LabelStep step_of_view(const SensorView& view, double agree, double facing, const Sides& sides,
                       Timestamp at, const SidesMemory& memory, const SidesConfig& config) {
  const auto seen = sides.views.find(view.sensor);
  std::optional<Exchanged> before;
  Labels labels{agree, std::abs(facing), 0.0};
  if (seen != sides.views.end()) {
    before = seen->second.exchanged;
    labels.elapsed = seconds(at - seen->second.seen);
    labels.agree *= std::min(1.0, labels.elapsed / kFrameTime);
  }
  const auto habit = memory.habits.find(view.sensor);
  return step_labels(before, labels, habit == memory.habits.end() ? ExchangeHabit{} : habit->second,
                     config.habit);
}

/// True if the view counts: it does so once it has clearly shown left and right.
bool counts(const SensorView& view, double agree, const Sides& sides) {
  return std::abs(agree) > kClear || sides.views.contains(view.sensor);
}

void step_views(Instant& now, const Person& person, const Spans& spans, const Sides& sides,
                const SidesMemory& memory, const SidesConfig& config) {
  const Eigen::Vector3d forward = forward_of(spans);
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    const SensorView& view = person.views[v];
    const auto facing = facing_of(view, forward);
    const bool known = facing && counts(view, now.agree[v], sides);
    now.steps.push_back(
        known ? step_of_view(view, now.agree[v], *facing, sides, now.at, memory, config)
              : LabelStep{});
  }
}

bool nobody_tells(const Instant& now) {
  double sum = 0.0;
  for (const double agree : now.agree) sum += std::abs(agree);
  return sum < kBlind;
}

/// Log odds that the held sides are right, from the labels of all sensors that tell front from
/// rear.
double sight_of_all(const Instant& now, const Person& person, const SidesMemory& memory,
                    const TellingPrior& prior) {
  double sum = 0.0;
  for (std::size_t v = 0; v < person.views.size(); ++v)
    sum += sight_log_odds(now.agree[v], known_of(person.views[v].sensor, memory), prior);
  return sum;
}

/// The evidence of an instant.  A view's first evidence counts in full, later evidence only as far
/// as it is new.
Evidence evidence_of(const Instant& now, const Person& person, Sides& sides, const Spans& spans,
                     const SidesMemory& memory, const SidesConfig& config) {
  Evidence evidence;
  evidence.news = now.first
                      ? now.posture
                      : new_evidence(now.posture, sides.posture, now.elapsed, config.posture.same);
  evidence.news +=
      now.first ? now.worn : new_evidence(now.worn, sides.worn, now.elapsed, config.worn.same);
  sides.worn = now.worn;
  for (const LabelStep& step : now.steps) evidence.news += step.log_ratio;
  const double sight = sight_of_all(now, person, memory, config.telling);
  if (!now.first)
    evidence.news += new_evidence(sight, sides.sight, now.elapsed, config.telling.same);
  sides.sight = sight;
  evidence.walking = now.upright * sides.walk.log_odds(forward_of(spans), config.walking);
  evidence.share = now.first ? 1.0 : std::min(1.0, now.elapsed / config.walking.same);
  sides.posture = now.posture;
  return evidence;
}

void turn_round(Instant& now, Sides& sides, Spans& spans) {
  sides.filter.turn_round();
  sides.posture = -sides.posture;
  sides.sight = -sides.sight;
  sides.worn = -sides.worn;
  for (Spans* each : {&sides.spans, &spans}) {
    for (Eigen::Vector3d& span : *each) span = -span;
  }
  now.exchanged.flip();
  for (LabelStep& step : now.steps) std::swap(step.exchanged.held, step.exchanged.opposite);
}

bool must_turn(const PersonFilter& filter, bool first, const SidesConfig& config) {
  const double right = filter.right();
  return std::log((1.0 - right) / right) > (first ? 0.0 : config.change_odds);
}

/// Learns habits, but only while the sides are certain and the person is upright, because the angle
/// to the sensor is one about the vertical, and from views that were seen before.
void learn(const Instant& now, const Person& person, const Sides& sides, SidesMemory& memory,
           const SidesConfig& config) {
  if (sides.filter.right() < config.learn_from || now.upright < 1.0) return;
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    const Passage& passage = now.steps[v].passage;
    if (!(passage.elapsed > 0)) continue;
    const SensorId& sensor = person.views[v].sensor;
    memory.habits[sensor].learn(passage, config.habit);
    memory.telling[sensor].learn(passage, config.telling);
  }
}

void apply(const Instant& now, const Spans& spans, Person& person) {
  const Eigen::Vector3d forward = forward_of(spans);
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    SensorView& view = person.views[v];
    if (now.exchanged[v]) exchange_sides(view.skeleton);
    if (const auto facing = facing_of(view, forward)) view.facing = *facing;
  }
}

void remember(const Instant& now, const Person& person, const Spans& spans, Sides& sides,
              const SidesConfig& config) {
  sides.seen = now.at;
  sides.spans = now.first
                    ? spans
                    : followed(sides.spans, spans, now.elapsed / (now.elapsed + config.smoothing));
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    if (counts(person.views[v], now.agree[v], sides))
      sides.views[person.views[v].sensor] = {now.at, now.steps[v].exchanged};
  }
}

Sides new_sides(const Instant& now, const SidesConfig& config) {
  return {now.at, agreed_spans(now.views), PersonFilter(config.person), {}, 0.0, 0.0, 0.0, {}};
}

}  // namespace

void resolve_sides(Person& person, Timestamp instant, SidesMemory& memory,
                   const SidesConfig& config, std::span<const Figure> flat) {
  if (!config.resolve || person.views.empty()) return;
  if (config.by == SidesBy::Shoulders) {
    resolve_sides_by_shoulders(person, instant, memory.shoulders);
    return;
  }
  Instant now{.at = instant, .views = all_spans(person)};
  now.upright = upright_share(trunk_of(person.views), config.upright);
  auto before = recall(memory, person.id, instant, config);
  now.first = !before;
  Sides sides = before ? std::move(*before) : new_sides(now, config);
  now.elapsed = seconds(instant - sides.seen);
  look_at_views(now, person, flat, sides, memory, config);
  Spans spans = joined(now);
  spans = followed(sides.spans, spans, trust_in(spans, sides.spans));
  keep_lost(spans, sides.spans);
  step_views(now, person, spans, sides, memory, config);
  now.posture = posture_log_odds(person.views, left_of(spans), now.upright, config.posture);
  now.worn = worn_log_odds(person, now.exchanged, flat, config.worn);
  sides.walk.follow(person.views, instant, config.walking);
  sides.filter.predict(now.elapsed, nobody_tells(now), config.person);
  const double slipped = slipped_by_turning(now, spans, sides, config);
  sides.filter.slip(slipped);
  Evidence evidence = evidence_of(now, person, sides, spans, memory, config);
  evidence.news += seen_anew(slipped, now.posture + now.worn);
  sides.filter.update(evidence);
  if (must_turn(sides.filter, now.first, config)) {
    turn_round(now, sides, spans);
  } else {
    learn(now, person, sides, memory, config);
  }
  apply(now, spans, person);
  mend_limbs(person, sides.spans, config.limbs);
  remember(now, person, spans, sides, config);
  person.sides_confidence = sides.filter.right();
  memory.people.insert_or_assign(person.id, std::move(sides));
}

}  // namespace chorus::facing
