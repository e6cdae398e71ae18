#include "common/posture/neutral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/base/units.h"

namespace chorus::posture {
namespace {

/// What a bound is asked of: all measures, or those of one arm.
enum class Of : std::uint8_t { Body, LeftArm, RightArm };

/// Below these, a posture may be somebody's upright stance.  They are wide because what is measured
/// includes the errors that the stance is to take off: a Kinect's knees err by up to 15 degrees.
struct Bound {
  Of of;
  std::size_t measure;
  double most;
  std::string_view is;
};
const std::array kBounds{
    Bound{Of::Body, index_of(Centre::TrunkFlexion), deg(20), "the trunk is bent"},
    Bound{Of::Body, index_of(Centre::TrunkSideBend), deg(15), "the trunk leans sideways"},
    Bound{Of::Body, index_of(Limb::KneeFlexion, Side::Left), deg(25), "the left knee is bent"},
    Bound{Of::Body, index_of(Limb::KneeFlexion, Side::Right), deg(25), "the right knee is bent"},
    Bound{Of::LeftArm, index_of(Limb::UpperArmElevation, Side::Left), deg(30),
          "the left arm is raised"},
    Bound{Of::RightArm, index_of(Limb::UpperArmElevation, Side::Right), deg(30),
          "the right arm is raised"},
    Bound{Of::LeftArm, index_of(Limb::ElbowFlexion, Side::Left), deg(45), "the left elbow is bent"},
    Bound{Of::RightArm, index_of(Limb::ElbowFlexion, Side::Right), deg(45),
          "the right elbow is bent"}};

constexpr std::size_t kLeastInstants = 5;
constexpr std::size_t kLeastUpright = 30;
/// A stretch is calm if no bounded angle varies by more (its standard deviation).
constexpr double kCalm = deg(4);
/// The middle share of the stretch's instants that must be upright.
constexpr double kUprightShare = 0.9;

Of part_of(std::size_t measure) {
  for (const Side side : kSides) {
    if (index_of(Limb::UpperArmRaise, side) <= measure &&
        measure <= index_of(Limb::HandReach, side))
      return side == Side::Left ? Of::LeftArm : Of::RightArm;
  }
  return Of::Body;
}

bool holds(const Bound& bound, const Measures& measures) {
  return std::abs(measures.values[bound.measure]) <= bound.most;
}

/// Upright, as far as these measures need it.
bool stands(const Measures& measures, Of part) {
  return std::ranges::all_of(kBounds, [&](const Bound& bound) {
    return (bound.of != Of::Body && bound.of != part) || holds(bound, measures);
  });
}

double median_of(std::span<const Instant> instants, std::size_t measure) {
  std::vector<double> values;
  // What is shortened counts by its size: an arm that swings to both sides does not hang straight.
  const bool by_size = row_of(measure).zeroing == Zeroing::Shortened;
  for (const Instant& each : instants) {
    const double value = each.measures.values[measure];
    if (std::isfinite(value)) values.push_back(by_size ? std::abs(value) : value);
  }
  if (values.size() < kLeastInstants) return std::nan("");
  return median(std::move(values));
}

/// The largest standard deviation of a bounded angle; infinite if one is not measured.
double unrest(std::span<const Instant> instants) {
  double worst = 0.0;
  for (const Bound& bound : kBounds) {
    double sum = 0.0;
    double squares = 0.0;
    for (const Instant& each : instants) {
      const double value = each.measures.values[bound.measure];
      sum += value;
      squares += value * value;
    }
    const double n = static_cast<double>(instants.size());
    const double variance = squares / n - (sum / n) * (sum / n);
    if (!std::isfinite(variance)) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, std::sqrt(std::max(0.0, variance)));
  }
  return worst;
}

double upright_share(std::span<const Instant> instants) {
  const auto upright = std::ranges::count_if(
      instants, [](const Instant& each) { return not_upright(each.measures).empty(); });
  return static_cast<double>(upright) / static_cast<double>(instants.size());
}

std::optional<Neutral> calmest(std::span<const Instant> instants, Duration length) {
  constexpr Duration kStep = std::chrono::milliseconds(200);
  std::optional<std::span<const Instant>> best;
  double least = kCalm;
  std::size_t end = 0;
  Timestamp next{};
  for (std::size_t begin = 0; begin < instants.size(); ++begin) {
    if (begin > 0 && instants[begin].at < next) continue;
    next = instants[begin].at + kStep;
    while (end < instants.size() && instants[end].at - instants[begin].at < length) ++end;
    if (end == instants.size()) break;
    const auto stretch = instants.subspan(begin, end - begin);
    if (stretch.size() < kLeastInstants || upright_share(stretch) < kUprightShare) continue;
    const double moved = unrest(stretch);
    if (moved < least) {
      least = moved;
      best = stretch;
    }
  }
  if (!best) return std::nullopt;
  return stance_of(*best);
}

double without(double value, double stance, Zeroing zeroing) {
  if (!std::isfinite(stance) || zeroing == Zeroing::Kept) return value;
  if (zeroing == Zeroing::Shifted) return value - stance;
  return std::copysign(std::max(0.0, std::abs(value) - std::abs(stance)), value);
}

}  // namespace

Measures relative_to(const Neutral& neutral, const Measures& measures) {
  Measures out;
  for (std::size_t m = 0; m < kMeasures; ++m)
    out.values[m] = std::isnan(measures.values[m])
                        ? measures.values[m]
                        : without(measures.values[m], neutral.stance.values[m], row_of(m).zeroing);
  return out;
}

std::string not_upright(const Measures& measures) {
  for (const Bound& bound : kBounds) {
    const double value = measures.values[bound.measure];
    if (!std::isfinite(value)) return fmt::format("{} is not measured", name_of(bound.measure));
    if (std::abs(value) > bound.most)
      return fmt::format("{} by {:.0f} degrees", bound.is, to_deg(std::abs(value)));
  }
  return {};
}

Neutral stance_of(std::span<const Instant> instants) {
  Neutral neutral;
  neutral.from = instants.front().at;
  neutral.until = instants.back().at;
  neutral.instants = instants.size();
  for (std::size_t m = 0; m < kMeasures; ++m) neutral.stance.values[m] = median_of(instants, m);
  return neutral;
}

Result<Neutral> neutral_of(std::span<const Instant> instants) {
  if (instants.size() < kLeastInstants)
    return fail(ErrorCode::Timeout, "neutral stance",
                fmt::format("was seen at {} instants only; stand upright, arms down, where sensors "
                            "see you, for two seconds",
                            instants.size()));
  const Neutral neutral = stance_of(instants);
  const std::string why = not_upright(neutral.stance);
  if (!why.empty())
    return fail(ErrorCode::InvalidArgument, "neutral stance",
                why + "; stand upright, knees straight, arms hanging down");
  return neutral;
}

std::optional<Neutral> calm_stance(std::span<const Instant> instants) {
  if (auto found = calmest(instants, kStanceLasts)) return found;
  return calmest(instants, kStanceLasts / 2);
}

std::optional<Neutral> standing_stance(std::span<const Instant> instants,
                                       std::span<const Instant> judged) {
  std::array<std::vector<Instant>, 3> standing;
  for (std::size_t i = 0; i < std::min(instants.size(), judged.size()); ++i) {
    for (const Of part : {Of::Body, Of::LeftArm, Of::RightArm}) {
      if (stands(judged[i].measures, part))
        standing[static_cast<std::size_t>(part)].push_back(instants[i]);
    }
  }
  if (standing.front().size() < kLeastUpright) return std::nullopt;
  Neutral neutral = stance_of(standing.front());
  for (std::size_t m = 0; m < kMeasures; ++m)
    neutral.stance.values[m] = median_of(standing[static_cast<std::size_t>(part_of(m))], m);
  return neutral;
}

std::optional<Neutral> find_neutral(std::span<const Instant> instants) {
  if (auto found = calm_stance(instants)) return found;
  return standing_stance(instants, instants);
}

}  // namespace chorus::posture
