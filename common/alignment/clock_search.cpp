#include "common/alignment/clock_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/geometry/rigid_fit.h"

namespace chorus::alignment {
namespace {

constexpr double kStep = 0.05;         // between offsets that are tried [s]
constexpr double kThinned = 0.1;       // between points that are compared [s]
constexpr double kLeastCommon = 5.0;   // [s]
constexpr double kLeastOverlap = 0.5;  // of the shorter trace that the two must have in common
constexpr double kOther = 0.5;         // offsets nearer than this are one minimum [s]
constexpr double kAlike = 1.2;         // a second minimum this much worse may be the true one
constexpr double kOneMotion = 0.3;     // [m]; with a larger misfit they show different motions
constexpr double kPerfect = 0.002;     // [m], below which misfits are not told apart
constexpr double kTrim = 3.0;          // medians beyond which a point does not count
constexpr std::size_t kMostOffsets = 100'000;

Trace thinned(const Trace& trace) {
  Trace out;
  for (const TracePoint& point : trace) {
    if (out.empty() || point.time - out.back().time >= kThinned) out.push_back(point);
  }
  return out;
}

double length_of(const Trace& trace) {
  return trace.empty() ? 0.0 : trace.back().time - trace.front().time;
}

struct Matched {
  std::vector<Eigen::Vector3d> ours;
  std::vector<Eigen::Vector3d> reference;
};

Matched matched(const Trace& ours, const Trace& reference, double offset, double max_gap) {
  Matched out;
  for (const TracePoint& point : ours) {
    const auto there = trace_at(reference, point.time - offset, max_gap);
    if (!there) continue;
    out.ours.push_back(point.place);
    out.reference.push_back(there->place);
  }
  return out;
}

/// Root mean square misfit without what is far beyond the median [m]; none if too little is left.
std::optional<double> misfit(const Matched& pairs, std::size_t least) {
  if (pairs.ours.size() < least) return std::nullopt;
  std::vector<double> weights(pairs.ours.size(), 1.0);
  std::optional<double> rms;
  for (int pass = 0; pass < 2; ++pass) {
    const auto fit = fit_yaw(pairs.reference, pairs.ours, weights);
    if (!fit) return std::nullopt;
    rms = fit->rms;
    std::vector<double> off;
    for (std::size_t i = 0; i < pairs.ours.size(); ++i)
      off.push_back((pairs.ours[i] - fit->target_from_source * pairs.reference[i]).norm());
    const double most = kTrim * median(off);
    for (std::size_t i = 0; i < off.size(); ++i) weights[i] = off[i] <= most ? 1.0 : 0.0;
  }
  return rms;
}

struct Tried {
  double offset = 0.0;
  double misfit = 0.0;
};

std::pair<double, double> range_of(const Trace& ours, const Trace& reference,
                                   const AlignmentConfig& config) {
  if (config.clock_range) return {-*config.clock_range, *config.clock_range};
  return {ours.front().time - reference.back().time + kLeastCommon,
          ours.back().time - reference.front().time - kLeastCommon};
}

/// The best offset that is not a neighbour of `best`.
std::optional<Tried> next_minimum(const std::vector<Tried>& tried, const Tried& best) {
  std::optional<Tried> other;
  for (std::size_t i = 1; i + 1 < tried.size(); ++i) {
    const Tried& each = tried[i];
    if (std::abs(each.offset - best.offset) < kOther) continue;
    if (each.misfit > tried[i - 1].misfit || each.misfit > tried[i + 1].misfit) continue;
    if (!other || each.misfit < other->misfit) other = each;
  }
  return other;
}

}  // namespace

std::optional<TracePoint> trace_at(const Trace& trace, double time, double max_gap) {
  const auto after = std::ranges::lower_bound(trace, time, {}, &TracePoint::time);
  if (after == trace.end()) return std::nullopt;
  if (after->time == time) return *after;
  if (after == trace.begin()) return std::nullopt;
  const TracePoint& a = *std::prev(after);
  const TracePoint& b = *after;
  if (b.time - a.time > max_gap) return std::nullopt;
  const double s = (time - a.time) / (b.time - a.time);
  TracePoint out{time, a.place + s * (b.place - a.place), {}};
  if (a.axes && b.axes) out.axes = a.axes->slerp(s, *b.axes);
  return out;
}

Result<double> rough_offset(const Trace& ours, const Trace& reference,
                            const AlignmentConfig& config) {
  const auto little = [&] {
    std::string message =
        fmt::format("the two have less than {} s in common: were they recorded at the same time?",
                    kLeastCommon);
    if (config.clock_range)
      message += fmt::format(" Their clocks may differ by {} s here; --clock allows more",
                             *config.clock_range);
    return fail(ErrorCode::NotFound, "align", std::move(message));
  };
  if (length_of(ours) < kLeastCommon || length_of(reference) < kLeastCommon) return little();
  const Trace few = thinned(ours);
  const double common =
      std::max(kLeastCommon, kLeastOverlap * std::min(length_of(ours), length_of(reference)));
  // Holes in our own trace are not the reference's fault.
  const double filled = static_cast<double>(few.size()) * kThinned / length_of(ours);
  const auto least = static_cast<std::size_t>(common / kThinned * std::min(1.0, 0.9 * filled));
  const auto [from, to] = range_of(ours, reference, config);
  if (to < from || (to - from) / kStep > static_cast<double>(kMostOffsets)) return little();
  std::vector<Tried> tried;
  for (double offset = from; offset <= to + kStep / 2; offset += kStep) {
    if (const auto off = misfit(matched(few, reference, offset, config.max_gap), least))
      tried.push_back({offset, *off});
  }
  if (tried.empty()) return little();
  const Tried best = *std::ranges::min_element(tried, {}, &Tried::misfit);
  const auto other = next_minimum(tried, best);
  if (best.misfit < kOneMotion && other && other->misfit < kAlike * best.misfit + kPerfect)
    return fail(
        ErrorCode::Conflict, "align",
        fmt::format("the motion repeats itself: clock offsets that are {:.2f} s apart fit "
                    "alike ({:.0f} and {:.0f} mm); walk another way, or narrow --clock",
                    std::abs(best.offset - other->offset), 1e3 * best.misfit, 1e3 * other->misfit));
  return best.offset;
}

}  // namespace chorus::alignment
