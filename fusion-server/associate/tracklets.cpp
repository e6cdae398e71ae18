#include "fusion-server/associate/tracklets.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

namespace chorus::associate {
namespace {

constexpr std::size_t kMostTracklets = 12;
constexpr double kLongestTracklet = 1.0;   // [s] in view; as long as a Repeatability is of.
constexpr double kShortestTracklet = 0.2;  // [s] in view; a shorter one is not cut again.
// [s] in view before a cut from which the build before it can be compared.
constexpr double kKnown = 0.5;

/// In how much of the tracklet each of its bodies was in view.
double share_of(const Carrier& carrier, const Tracklet& tracklet) {
  return tracklet.time > 0 ? std::min(1.0, carrier.time / tracklet.time) : 1.0;
}

/// How many bodies go on from one tracklet to the other.
double bodies_in_both(const Tracklet& one, const Tracklet& other) {
  double count = 0.0;
  for (const Carrier& each : one.carriers) {
    const auto same = std::ranges::find(other.carriers, each.body, &Carrier::body);
    if (same != other.carriers.end())
      count += std::min(share_of(each, one), share_of(*same, other));
  }
  return count;
}

void add_carriers(Tracklet& tracklet, std::span<const std::uint64_t> bodies, double elapsed) {
  tracklet.time += elapsed;
  for (const std::uint64_t body : bodies) {
    const auto known = std::ranges::find(tracklet.carriers, body, &Carrier::body);
    if (known == tracklet.carriers.end()) {
      tracklet.carriers.push_back({body, elapsed});
    } else {
      known->time += elapsed;
    }
  }
}

}  // namespace

std::uint64_t key_of(const SensorId& sensor, BodyId body) {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15ULL;  // mixes both well
  return std::hash<std::string>{}(sensor.str()) ^ (kOdd * (body.value + 1));
}

void Tracklets::cut(double continuity) {
  if (tracklets_.empty()) return;
  Tracklet& last = tracklets_.back();
  if (tracklets_.size() > 1 && sight_of(last.build) < kShortestTracklet) {
    last.continuity = std::min(last.continuity, continuity);
    last.by_time = false;
  } else {
    next_ = std::min(continuity, next_.value_or(continuity));
  }
}

/// A change within a tracklet leaves bodies of both people in it, so those before and after it
/// count, too.
double Tracklets::carried(std::size_t cut) const {
  const Tracklet& here = tracklets_[cut];
  if (!here.by_time || cut + 3 < tracklets_.size()) return here.carried;
  const Tracklet& before = tracklets_[cut - 1];
  double bodies = bodies_in_both(before, here);
  if (cut + 1 < tracklets_.size())
    bodies = std::min(bodies, bodies_in_both(before, tracklets_[cut + 1]));
  return kUnbroken * (std::max(1.0, bodies) - 1.0);
}

/// Begins a tracklet.  What carried the person over the third last cut is known by now.
void Tracklets::begin(Timestamp instant) {
  const double continuity = next_.value_or(kUnbroken);
  tracklets_.push_back({instant, instant, continuity, !next_});
  next_.reset();
  if (tracklets_.size() < 4) return;
  const std::size_t known = tracklets_.size() - 3;
  tracklets_[known].carried = carried(known);
  tracklets_[known - 1].carriers.clear();
}

void Tracklets::add(const Spans& spans, Timestamp instant, double elapsed,
                    std::span<const std::uint64_t> bodies) {
  const bool full = !tracklets_.empty() && sight_of(tracklets_.back().build) >= kLongestTracklet;
  if (tracklets_.empty() || full || next_) begin(instant);
  tracklets_.back().build.add(spans, elapsed);
  add_carriers(tracklets_.back(), bodies, elapsed);
  tracklets_.back().end = instant;
  if (tracklets_.size() <= kMostTracklets) return;
  tracklets_[1].build = before(2);
  tracklets_[1].begin = tracklets_[0].begin;
  tracklets_.erase(tracklets_.begin());
}

void Tracklets::precede(const Build& known, Timestamp seen, double continuity) {
  if (!tracklets_.empty()) {
    tracklets_.front().continuity = continuity;
    tracklets_.front().by_time = false;
  }
  tracklets_.insert(tracklets_.begin(), {seen, seen, kUnbroken, true, 0.0, known});
}

std::optional<Doubt> Tracklets::doubt(const Repeatability& repeatability) const {
  std::vector<Build> after(tracklets_.size() + 1);
  for (std::size_t i = tracklets_.size(); i > 0; --i) {
    after[i - 1] = after[i];
    after[i - 1].add(tracklets_[i - 1].build);
  }
  std::optional<Doubt> most;
  Build before;
  for (std::size_t cut = 1; cut < tracklets_.size(); ++cut) {
    before.add(tracklets_[cut - 1].build);
    if (sight_of(before) < kKnown || !(sight_of(after[cut]) > 0)) continue;
    const double odds =
        tracklets_[cut].continuity + likeness(stated(before), stated(after[cut]), repeatability);
    if (!most || odds < most->odds) most = {cut, odds, carried(cut)};
  }
  return most;
}

Build Tracklets::before(std::size_t cut) const {
  Build sum;
  for (std::size_t i = 0; i < std::min(cut, tracklets_.size()); ++i) sum.add(tracklets_[i].build);
  return sum;
}

Build Tracklets::after(std::size_t cut) const {
  Build sum;
  for (std::size_t i = cut; i < tracklets_.size(); ++i) sum.add(tracklets_[i].build);
  return sum;
}

void Tracklets::keep_after(std::size_t cut) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(cut, tracklets_.size()));
  tracklets_.erase(tracklets_.begin(), tracklets_.begin() + count);
}

}  // namespace chorus::associate
