#include "common/characteristics/turning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/body/facing.h"
#include "common/geometry/rotation.h"

namespace chorus::characteristics {
namespace {

constexpr double kPi = std::numbers::pi;
// Otto 3.2 says 40 deg, but trackers may stay at 40 while the person turns on.
constexpr double kReliable = deg(30);
constexpr double kBehind = deg(135);  // from here on people turn their back, as in facing
constexpr double kInFront = deg(45);
constexpr double kHolds = 0.3;        // a change of labels that is shorter than this is a slip [s]
constexpr double kLeastBehind = 1.0;  // [s]
constexpr double kMostly = 0.8;       // share of the time
constexpr double kTurningRate = deg(3);  // slower is standing [rad/s]
constexpr double kRateOver = 0.5;        // time over which the rate is taken, to either side [s]
constexpr double kFastest = deg(120);    // of people who turn on the spot [rad/s]
constexpr double kTurnJump = deg(20);    // by which shoulders are wrong from sight to sight [rad]
constexpr double kShortest = 1e-3;       // [s]
constexpr double kWayShare = 1.0 / 12;   // of a turn: 30 deg
constexpr double kAtTheEnd = 1.0;        // last part of the recording [s]
constexpr double kNarrowest = 0.12;      // narrower shoulders have no direction [m]

/// The angle of the front as shown; none where the shoulders are too narrow to have one.
std::optional<double> shown_angle(const Skeleton<SensorSpace>& body) {
  const Joint& left = body[JointId::ShoulderLeft];
  const Joint& right = body[JointId::ShoulderRight];
  if (!left.seen() || !right.seen()) return std::nullopt;
  Eigen::Vector3d span = left.position - right.position;
  span.y() = 0;
  if (span.norm() < kNarrowest) return std::nullopt;
  return facing_angle(body);
}

/// The nearest half turn, as a whole number.
long half_turns(double angle) { return std::lround(angle / kPi); }

struct Followed {
  std::size_t sight = 0;
  double time = 0.0;   ///< [s]
  double shown = 0.0;  ///< As labelled [rad].
  double angle = 0.0;  ///< Independent of labels, not wrapped [rad].
  /// False while the sensor exchanges the labels: the line through the shoulders is meaningless
  /// then.
  bool kept = true;
  [[nodiscard]] bool reliable() const {
    return kept && std::abs(angle - kPi * static_cast<double>(half_turns(angle))) <= kReliable;
  }
};

std::vector<Followed> follow(const OnePerson& person) {
  std::vector<Followed> all;
  std::size_t last = 0;  // the last one that was kept
  for (std::size_t i = 0; i < person.sights.size(); ++i) {
    const auto shown = shown_angle(person.sights[i].body);
    if (!shown) continue;
    const double before = all.empty() ? 0.0 : all[last].angle;
    const double angle = *shown + kPi * static_cast<double>(half_turns(before - *shown));
    const double time = seconds(person.sights[i].at - person.sights.front().at);
    const double reach = all.empty() ? kPi : kTurnJump + kFastest * (time - all[last].time);
    const bool kept = std::abs(angle - before) <= reach;
    all.push_back({i, time, *shown, angle, kept});
    if (kept) last = all.size() - 1;
  }
  return all;
}

/// Sights that were not kept get the angle between those before and after.
void fill_in(std::vector<Followed>& all) {
  std::size_t last = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].kept) continue;
    const double rate =
        (all[i].angle - all[last].angle) / std::max(kShortest, all[i].time - all[last].time);
    for (std::size_t k = last + 1; k < i; ++k)
      all[k].angle = all[last].angle + rate * (all[k].time - all[last].time);
    last = i;
  }
}

/// Between two reliable sights of neighbouring half turns the angle grows evenly with time.
void bridge_sides(std::vector<Followed>& all) {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].reliable()) continue;
    if (last && half_turns(all[*last].angle) != half_turns(all[i].angle)) {
      const Followed from = all[*last];
      const double rate =
          (all[i].angle - from.angle) / std::max(kShortest, all[i].time - from.time);
      for (std::size_t k = *last + 1; k < i; ++k)
        all[k].angle = from.angle + rate * (all[k].time - from.time);
    }
    last = i;
  }
}

/// Direction of a known turn, +1 or -1, from its first 30 degrees.
double way_of(const KnownTurn& turn, const std::vector<Followed>& all) {
  const double early = turn.from + kWayShare * (turn.to - turn.from);
  double before = 0.0;
  double sum = 0.0;
  for (const Followed& each : all) {
    if (each.time <= turn.from) before = each.shown;
    if (each.time > turn.from && each.time < early) sum += wrap_angle(each.shown - before);
  }
  return sum < 0 ? -1.0 : 1.0;
}

void turn_as_known(std::vector<Followed>& all, const std::vector<KnownTurn>& turns) {
  std::vector<double> angles(all.size(), 0.0);
  for (const KnownTurn& turn : turns) {
    const double way = way_of(turn, all);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double share = (all[i].time - turn.from) / std::max(kShortest, turn.to - turn.from);
      angles[i] += way * 2 * kPi * std::clamp(share, 0.0, 1.0);
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) all[i].angle = angles[i];
}

/// Undoes short changes of labels.
void without_slips(std::vector<Stance>& stances, const OnePerson& person) {
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < stances.size(); ++i) {
    if (stances[i].angle) known.push_back(i);
  }
  for (std::size_t from = 0; from < known.size();) {
    std::size_t to = from;
    const bool state = stances[known[from]].exchanged;
    while (to < known.size() && stances[known[to]].exchanged == state) ++to;
    const bool inside = from > 0 && to < known.size();
    if (inside && seconds(person.sights[known[to]].at - person.sights[known[from]].at) < kHolds) {
      for (std::size_t k = from; k < to; ++k) stances[known[k]].exchanged = !state;
    }
    from = to;
  }
}

/// Growth of the angle away from the sensor at each sight [rad/s]; 0 where it is not known.
std::vector<double> rates_of(const OnePerson& person, const std::vector<Stance>& stances) {
  std::vector<double> rates(stances.size(), 0.0);
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(kRateOver / person.step)));
  for (std::size_t i = 0; i < stances.size(); ++i) {
    const std::size_t from = i - std::min(i, reach);
    const std::size_t to = std::min(stances.size() - 1, i + reach);
    if (!stances[i].angle || !stances[from].angle || !stances[to].angle) continue;
    const double lasts = seconds(person.sights[to].at - person.sights[from].at);
    if (lasts <= 0.0) continue;
    const double side = wrap_angle(*stances[i].angle) < 0 ? -1.0 : 1.0;
    rates[i] = side * (*stances[to].angle - *stances[from].angle) / lasts;
  }
  return rates;
}

void count(TurnSector& sector, bool exchanged, double rate, double lasts) {
  if (rate >= 0) {
    sector.away_s += lasts;
    sector.exchanged_away_s += exchanged ? lasts : 0.0;
  } else {
    sector.back_s += lasts;
    sector.exchanged_back_s += exchanged ? lasts : 0.0;
  }
}

/// Share of the time with exchanged labels between two angles; none if nobody was there for long.
std::optional<double> share_between(const Exchange& exchange, double least, double most) {
  double lasts = 0.0;
  double exchanged = 0.0;
  const double width = kPi / static_cast<double>(kTurnSectors);
  for (std::size_t i = 0; i < kTurnSectors; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * width;
    if (middle < least || middle > most) continue;
    const TurnSector& sector = exchange.sectors[i];
    lasts += sector.away_s + sector.back_s;
    exchanged += sector.exchanged_away_s + sector.exchanged_back_s;
  }
  if (lasts < kLeastBehind) return std::nullopt;
  return exchanged / lasts;
}

/// Whether the person does not turn their back to the sensor for most of the last second.
bool ends_facing(const OnePerson& person, const std::vector<Stance>& stances) {
  std::size_t all = 0;
  std::size_t facing = 0;
  const Timestamp late = person.sights.back().at - from_seconds(kAtTheEnd);
  for (std::size_t i = 0; i < stances.size(); ++i) {
    if (person.sights[i].at < late || !stances[i].angle) continue;
    ++all;
    facing += away_from_sensor(*stances[i].angle) < kBehind ? 1 : 0;
  }
  return 2 * facing >= all;
}

FrontRear judged(const Exchange& exchange) {
  const auto behind = share_between(exchange, kBehind, kPi);
  const auto front = share_between(exchange, 0.0, kInFront);
  if (!behind) return FrontRear::Unknown;
  if (front && *front > kMostly) return FrontRear::Mirrored;
  if (*behind > kMostly) return FrontRear::TakesForFacing;
  return *behind < 1.0 - kMostly ? FrontRear::Tells : FrontRear::Mixed;
}

}  // namespace

double away_from_sensor(double angle) { return std::abs(wrap_angle(angle)); }

std::vector<Stance> stances_of(const OnePerson& person, const std::vector<KnownTurn>& turns) {
  std::vector<Followed> all = follow(person);
  if (turns.empty()) {
    fill_in(all);
    bridge_sides(all);
  } else {
    turn_as_known(all, turns);
  }
  std::vector<Stance> stances(person.sights.size());
  for (const Followed& each : all)
    stances[each.sight] = {each.angle, std::cos(each.shown - each.angle) < 0};
  without_slips(stances, person);
  return stances;
}

Exchange exchange_of(const OnePerson& person, const std::vector<Stance>& stances) {
  Exchange exchange;
  const std::vector<double> rates = rates_of(person, stances);
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < stances.size(); ++i) {
    if (!stances[i].angle) continue;
    const double away = away_from_sensor(*stances[i].angle);
    const auto sector = std::min(
        kTurnSectors - 1, static_cast<std::size_t>(away / kPi * static_cast<double>(kTurnSectors)));
    count(exchange.sectors[sector], stances[i].exchanged, rates[i], person.step);
    if (std::abs(rates[i]) > kTurningRate) exchange.turned += std::abs(rates[i]) * person.step;
    if (last) {
      const double middle = away_from_sensor(0.5 * (*stances[i].angle + *stances[*last].angle));
      if (stances[i].exchanged && !stances[*last].exchanged) exchange.out.push_back(middle);
      if (!stances[i].exchanged && stances[*last].exchanged) exchange.back.push_back(middle);
    }
    last = i;
  }
  exchange.front_rear = ends_facing(person, stances) ? judged(exchange) : FrontRear::Unclear;
  return exchange;
}

}  // namespace chorus::characteristics
