#include "fusion-server/associate/tracklets.h"

#include <algorithm>
#include <limits>

namespace chorus::associate {
namespace {

constexpr std::size_t kMostTracklets = 12;
constexpr double kLongestTracklet = 1.0;   // [s] in view; as long as a Repeatability is of.
constexpr double kShortestTracklet = 0.2;  // [s] in view; a shorter one is not cut again.
// [s] in view before a cut from which the build before it can be compared.
constexpr double kKnown = 0.5;

}  // namespace

void Tracklets::cut(double continuity) {
  if (tracklets_.empty()) return;
  Tracklet& last = tracklets_.back();
  if (tracklets_.size() > 1 && sight_of(last.build) < kShortestTracklet) {
    last.continuity = std::min(last.continuity, continuity);
  } else {
    next_ = std::min(continuity, next_.value_or(continuity));
  }
}

void Tracklets::add(const Spans& spans, Timestamp instant, double elapsed) {
  if (!tracklets_.empty() && sight_of(tracklets_.back().build) >= kLongestTracklet) cut(kUnbroken);
  if (tracklets_.empty() || next_) {
    tracklets_.push_back({instant, instant, next_.value_or(kUnbroken)});
    next_.reset();
  }
  tracklets_.back().build.add(spans, elapsed);
  tracklets_.back().end = instant;
  if (tracklets_.size() <= kMostTracklets) return;
  tracklets_[1].build = before(2);
  tracklets_[1].begin = tracklets_[0].begin;
  tracklets_.erase(tracklets_.begin());
}

void Tracklets::precede(const Build& known, Timestamp seen, double continuity) {
  if (!tracklets_.empty()) tracklets_.front().continuity = continuity;
  tracklets_.insert(tracklets_.begin(), {seen, seen, kUnbroken, known});
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
    if (!most || odds < most->odds) most = {cut, odds};
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
