#include "common/positioning/tracker.h"

#include <algorithm>
#include <array>
#include <cmath>

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
constexpr double kKnownHeading = 0.3;        // Uncertainty of a heading that is stated [rad].
constexpr double kFirstHeadingSigma = 0.15;  // Of the first fit [rad].

}  // namespace

Tracker::Tracker(const TrackerSettings& settings)
    : settings_(settings), footing_(settings.stature), filter_(settings.cameras, settings.errors) {}

/// The person in the picture who fits pose and expectation best.
std::optional<Tracker::Found> Tracker::found_in(const Look& look,
                                                const suit::SuitPose& pose) const {
  std::optional<Found> best;
  double best_cost = 0.0;
  if (look.seen) return Found{*look.seen, 0.0, look.seen->heading.value_or(0.0)};
  for (const Skeleton<SensorSpace>& person : look.people) {
    const std::array<SeenRays, 1> rays{SeenRays{look.world_from_sensor, person}};
    const Position now = filter_.position();
    constexpr double kLeastSigma = 0.1;
    HeadingPrior prior{now.heading, std::max(kLeastSigma, now.heading_sigma)};
    const bool known = filter_.begun() || settings_.heading;
    if (!filter_.begun() && settings_.heading) prior = {*settings_.heading, kKnownHeading};
    const auto fit = known ? fit_landmarks(rays, pose, prior) : fit_any_heading(rays, pose);
    if (!fit) continue;
    Found found{{look.camera, look.world_from_sensor.translation(), fit->place,
                 fit->covariance.topLeftCorner<3, 3>(), fit->heading},
                fit->misfit,
                fit->heading};
    const double surprise = filter_.begun() ? filter_.surprise(found.seen) : 0.0;
    const double cost = fit->misfit * fit->misfit + surprise;
    if (best && best_cost <= cost) continue;
    best = found;
    best_cost = cost;
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
      filter_ = PositionFilter(settings_.cameras, settings_.errors);
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

std::optional<Tracked> Tracker::next(const Instant& instant) {
  const suit::Step step = footing_.next(instant.pose);
  const double dt = last_ ? std::max(0.0, seconds(instant.pose.time - *last_)) : 0.0;
  last_ = instant.pose.time;
  Tracked out;
  out.stance = step.stance;
  if (filter_.begun())
    filter_.predict({dt, step.moved, step.height, step.stance == suit::Stance::Flight});
  for (const Look& look : instant.looks) {
    const auto found = found_in(look, instant.pose);
    if (found && accept(*found, out)) last_seen_ = instant.pose.time;
  }
  if (!filter_.begun()) return std::nullopt;
  out.position = filter_.position();
  out.hidden = last_seen_ ? instant.pose.time - *last_seen_ : Duration{0};
  return out;
}

}  // namespace chorus::positioning
