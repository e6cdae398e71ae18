#include "common/positioning/tracker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry/rotation.h"

namespace chorus::positioning {
namespace {

// A picture that surprises more than this [variances per axis] is not believed, until as many in a
// row say the same.
constexpr double kMostSurprise = 9.0;
constexpr int kInARow = 8;
// A first fit that is worse may be at a wrong heading [standard deviations].
constexpr double kFirstMisfit = 1.8;
// After so many pictures in a row in which nobody fits, the beginning was wrong: it begins anew.
constexpr int kAnew = 12;
constexpr double kKnownHeading = 0.3;  // Uncertainty of a heading that is stated [rad].
constexpr double kMostFirstTurn = 2.0 * kKnownHeading;
constexpr double kFirstHeadingSigma = 0.15;  // Of the first fit [rad].
// After so long without a sight, an outline is looked for everywhere again.
constexpr Duration kLost = std::chrono::milliseconds(700);
// Of the suit's steps, per square root of a metre (common/suit/walk.cpp states the same).
constexpr double kStepSigma = 0.08;

std::size_t cameras_of(const TrackerSettings& settings) {
  return settings.method == Method::Both ? 2 * settings.cameras : settings.cameras;
}

}  // namespace

Tracker::Tracker(const TrackerSettings& settings)
    : settings_(settings),
      footing_(settings.stature),
      filter_(cameras_of(settings), settings.errors) {}

/// The person, with these labels of left and right, as the pose and the expectation have it.
std::optional<Tracker::Found> Tracker::found_as(const SeenRays& seen, const suit::SuitPose& pose,
                                                std::size_t camera) const {
  const std::span<const SeenRays> rays(&seen, 1);
  const Position now = filter_.position();
  constexpr double kLeastSigma = 0.1;
  HeadingPrior prior{now.heading, std::max(kLeastSigma, now.heading_sigma)};
  if (!filter_.begun() && settings_.heading) prior = {*settings_.heading, kKnownHeading};
  const auto fit = knows_heading() ? fit_landmarks(rays, pose, prior) : fit_any_heading(rays, pose);
  if (!fit) return std::nullopt;
  // A first picture that contradicts a known heading shows somebody else, or half a person.
  if (!filter_.begun() && settings_.heading &&
      std::abs(wrap_angle(fit->heading - prior.heading)) > kMostFirstTurn)
    return std::nullopt;
  return Found{{camera, seen.world_from_sensor.translation(), fit->place,
                fit->covariance.topLeftCorner<3, 3>(), fit->heading},
               fit->misfit,
               fit->heading};
}

/// The person in the picture, and the labels of left and right, that fit pose and expectation best.
/// While no heading is known, labels that are exchanged fit at the opposite one, so they are taken
/// as they are.
std::optional<Tracker::Found> Tracker::found_in(const Look& look,
                                                const suit::SuitPose& pose) const {
  std::optional<Found> best;
  double best_cost = 0.0;
  for (const Skeleton<SensorSpace>& person : look.people) {
    for (const Exchanged what : kExchanges) {
      // Labels that fit as they are cannot be beaten by exchanged ones, which cost something.
      const bool fits = best && best_cost <= kExchangeCost;
      if (what != Exchanged::Nothing && (fits || !knows_heading())) break;
      const auto found =
          found_as({look.world_from_sensor, relabelled(person, what)}, pose, look.camera);
      if (!found) continue;
      const double surprise = filter_.begun() ? filter_.surprise(found->seen) : 0.0;
      const double cost = found->misfit * found->misfit + surprise +
                          (what == Exchanged::Nothing ? 0.0 : kExchangeCost);
      if (best && best_cost <= cost) continue;
      best = found;
      best_cost = cost;
    }
  }
  return best;
}

void Tracker::begin(const Found& found) {
  filter_.begin(found.seen, found.heading, kFirstHeadingSigma);
  refused_ = 0;
}

bool Tracker::accept(const Found& found, Tracked& out) {
  if (found.misfit > (filter_.begun() ? kLargestMisfit : kFirstMisfit)) {
    ++strangers_;
    if (++misfits_ >= kAnew) {
      filter_ = PositionFilter(cameras_of(settings_), settings_.errors);
      misfits_ = 0;
    }
    return false;
  }
  misfits_ = 0;
  if (!filter_.begun()) {
    begin(found);
  } else if (filter_.surprise(found.seen) > kMostSurprise) {
    if (++refused_ < kInARow) return false;
    filter_.forget_place();
  }
  refused_ = 0;
  filter_.see(found.seen);
  ++out.cameras;
  out.misfit = std::max(out.misfit, found.misfit);
  return true;
}

std::size_t Tracker::outline_camera(std::size_t camera) const {
  return settings_.method == Method::Both ? settings_.cameras + camera : camera;
}

bool Tracker::may_search(Duration now) {
  constexpr Duration kBetweenSearches = std::chrono::milliseconds(500);
  if (searched_ && now - *searched_ < kBetweenSearches) return false;
  searched_ = now;
  return true;
}

/// Somebody who fits, in the first picture that has any.
std::optional<SightedPlace> Tracker::first_sight(const Instant& instant, double height) {
  const double heading = settings_.heading.value_or(0.0);
  if (settings_.start) {
    SightedPlace out{*settings_.start, kStepSigma * kStepSigma * Eigen::Matrix3d::Identity(),
                     heading};
    out.place.y() = height;
    return out;
  }
  if (settings_.method == Method::Suit)
    return SightedPlace{{0.0, height, 0.0}, Eigen::Matrix3d::Zero(), heading};
  for (const Look& look : instant.looks) {
    if (!look.sight || !may_search(instant.pose.time)) continue;
    if (auto seen = look.sight->anywhere(instant.pose, settings_.heading, height)) return seen;
  }
  return std::nullopt;
}

/// Takes the outline in one picture into the filter.
void Tracker::outline(const Look& look, const Instant& instant, double height, Tracked& out) {
  const Position now = filter_.position();
  const bool lost = !last_seen_ || instant.pose.time - *last_seen_ > kLost;
  const bool landmarks = uses_landmarks(settings_.method);
  std::optional<SightedPlace> seen;
  if (filter_.begun()) seen = look.sight->outlined({instant.pose, now.heading, now.place});
  if (!landmarks && lost && (!seen || seen->ambiguous) && may_search(instant.pose.time)) {
    const auto heading = filter_.begun() ? std::optional(now.heading) : settings_.heading;
    seen = look.sight->anywhere(instant.pose, heading, height);
    if (seen && filter_.begun()) filter_.forget_place();
  }
  if (!seen) return;
  out.ambiguous = out.ambiguous || seen->ambiguous;
  Found found{{outline_camera(look.camera), look.world_from_sensor.translation(), seen->place,
               seen->covariance, std::nullopt},
              0.0,
              seen->heading};
  // A second person or a chair that fits better does not pull the person there.
  if (landmarks && filter_.surprise(found.seen) > kMostSurprise) return;
  if (accept(found, out)) last_seen_ = instant.pose.time;
}

std::optional<Tracked> Tracker::filtered(const Instant& instant, const suit::Step& step,
                                         double dt) {
  Tracked out;
  if (filter_.begun())
    filter_.predict({dt, step.moved, step.height, step.stance == suit::Stance::Flight});
  for (const Look& look : instant.looks) {
    if (uses_landmarks(settings_.method)) {
      const auto found = found_in(look, instant.pose);
      if (found && accept(*found, out)) last_seen_ = instant.pose.time;
    }
    if (uses_pictures(settings_.method) && look.sight) outline(look, instant, step.height, out);
  }
  if (!filter_.begun()) return std::nullopt;
  out.position = filter_.position();
  return out;
}

/// One search of the paper around the last place, with the first picture that answers.
void Tracker::search(const Instant& instant, Tracked& out) {
  for (const Look& look : instant.looks) {
    if (!look.sight) continue;
    const ExpectedBody last{instant.pose, last_place_->heading, last_place_->place};
    const auto seen = look.sight->searched(last);
    if (!seen) continue;
    last_place_ = seen;
    walked_ = 0.0;
    last_seen_ = instant.pose.time;
    out.ambiguous = seen->ambiguous;
    ++out.cameras;
    return;
  }
}

std::optional<Tracked> Tracker::added_up(const Instant& instant, const suit::Step& step) {
  Tracked out;
  const bool by_steps = settings_.method == Method::Suit;
  if (!last_place_) {
    last_place_ = first_sight(instant, step.height);
    if (!last_place_) return std::nullopt;
    last_seen_ = instant.pose.time;
  } else if (by_steps) {
    last_place_->place += about_y(last_place_->heading) * step.moved;
    walked_ += step.moved.norm();
  }
  last_place_->place.y() = step.height;
  if (!by_steps) search(instant, out);
  out.position.place = last_place_->place;
  out.position.heading = last_place_->heading;
  const double more = kStepSigma * kStepSigma * walked_;
  out.position.covariance = last_place_->covariance + more * Eigen::Matrix3d::Identity();
  return out;
}

std::optional<Tracked> Tracker::next(const Instant& instant) {
  const suit::Step step = footing_.next(instant.pose);
  const double dt = last_ ? std::max(0.0, seconds(instant.pose.time - *last_)) : 0.0;
  last_ = instant.pose.time;
  const bool adds = settings_.method == Method::Suit || settings_.method == Method::Silhouettes;
  auto out = adds ? added_up(instant, step) : filtered(instant, step, dt);
  if (!out) return std::nullopt;
  out->stance = step.stance;
  out->hidden = last_seen_ ? instant.pose.time - *last_seen_ : Duration{0};
  return out;
}

}  // namespace chorus::positioning
