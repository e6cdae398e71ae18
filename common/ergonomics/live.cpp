#include "common/ergonomics/live.h"

#include <cmath>

#include "common/geometry/rotation.h"

namespace chorus::ergonomics {
namespace {

constexpr Duration kLasts = std::chrono::milliseconds(300);

/// `centre`, moved as far as the draw lies from the body as it is.
Measures moved(const Measures& centre, const Measures& draw, const Measures& nominal) {
  Measures out;
  for (std::size_t m = 0; m < posture::kMeasures; ++m) {
    const double by = draw.values[m] - nominal.values[m];
    out.values[m] =
        centre.values[m] + (posture::row_of(m).unit == posture::Unit::Angle ? wrap_angle(by) : by);
  }
  return out;
}

bool any_measured(const Measures& measures) {
  for (const double value : measures.values) {
    if (!std::isnan(value)) return true;
  }
  return false;
}

}  // namespace

std::string_view name_of(Unscored reason) {
  constexpr std::array<std::string_view, kReasons> kNames{"", "carried", "not seen",
                                                          "singular pose"};
  return kNames[static_cast<std::size_t>(reason)];
}

DoubtfulScore score_of(const Method& method, const Observation& observation, const Asked& asked) {
  if (observation.reason != Unscored::None) return {};
  return doubtful_score(method, {observation.seen, observation.draws, observation.sides_confidence},
                        asked);
}

Observation Observer::observe(const BodyAt& body) {
  Observation out;
  out.at = body.at;
  out.sides_confidence = body.sides_confidence;
  if (body.carried) {
    out.reason = Unscored::Carried;
    return out;
  }
  const posture::Posture now = posture::posture_of(body.body);
  walk_.add(body.at, points_of(body.body));
  held_.add(body.at, now.measures);
  const Measures centre = config_.held ? held_.median() : now.measures;
  if (!any_measured(now.measures)) {
    out.reason = Unscored::NotSeen;
    return out;
  }
  if (now.singular.hips_steep || now.singular.trunk_level) out.reason = Unscored::Singular;
  const posture::DrawnMeasures drawn =
      posture::drawn_measures(body.body, neutral_ ? posture::kLeftByStance : 1.0);
  out.doubtless = drawn.doubtless;
  const auto relative = [&](const Measures& measures) {
    return neutral_ ? posture::relative_to(*neutral_, measures) : measures;
  };
  out.seen = {relative(centre), walk_.walking()};
  for (std::size_t k = 0; k < posture::kDraws; ++k)
    out.draws[k] = relative(moved(centre, drawn.draws[k], now.measures));
  out.shown = steady_.follow(out.seen.measures);
  return out;
}

std::optional<posture::Neutral> stance_in(const std::vector<BodyAt>& bodies) {
  std::vector<posture::Instant> instants;
  instants.reserve(bodies.size());
  for (const BodyAt& body : bodies) {
    if (!body.carried) instants.push_back({body.at, posture::posture_of(body.body).measures});
  }
  return posture::find_neutral(instants);
}

ScoreRange ShownScore::follow(Timestamp at, const ScoreRange& score) {
  if (!shown_.known() || !score.known()) return shown_ = score;
  if (score == shown_) {
    next_ = score;
    since_ = at;
    return shown_;
  }
  if (!(score == next_)) {
    next_ = score;
    since_ = at;
  }
  if (at - since_ >= kLasts) shown_ = score;
  return shown_;
}

}  // namespace chorus::ergonomics
