#include "fusion-server/associate/build.h"

#include <algorithm>
#include <cmath>

#include "common/base/square.h"

namespace chorus::associate {
namespace {

constexpr double kMostSight = 60.0;  // [s]; older measurements fade.

struct Span {
  std::array<JointId, 2> left;
  std::array<JointId, 2> right;  ///< Equal to `left` for a length without sides.
  /// Weight in the size of the body: the length [m], because a joint's error is the same for short
  /// and long bones, and neighbouring bones have it with opposite signs, so that it cancels in
  /// their sum.  Less for the shoulders, whose width is seen from the front only.
  double weight;
};

constexpr std::array<Span, kSpans> kSpanTable{{
    {{JointId::SpineBase, JointId::SpineShoulder},
     {JointId::SpineBase, JointId::SpineShoulder},
     0.5},
    {{JointId::SpineShoulder, JointId::Head}, {JointId::SpineShoulder, JointId::Head}, 0.25},
    {{JointId::ShoulderLeft, JointId::ShoulderRight},
     {JointId::ShoulderLeft, JointId::ShoulderRight},
     0.12},
    {{JointId::ShoulderLeft, JointId::ElbowLeft},
     {JointId::ShoulderRight, JointId::ElbowRight},
     0.28},
    {{JointId::ElbowLeft, JointId::WristLeft}, {JointId::ElbowRight, JointId::WristRight}, 0.25},
    {{JointId::HipLeft, JointId::KneeLeft}, {JointId::HipRight, JointId::KneeRight}, 0.4},
    {{JointId::KneeLeft, JointId::AnkleLeft}, {JointId::KneeRight, JointId::AnkleRight}, 0.35},
}};

// Standard deviations [ln m], fitted on simulated sensors with seeds from 1001 on.  Repeatability
// says by how much the first two have to be increased for the sensors in use.
//
// Of one person's length from one period in view to another, whatever the number of views.
constexpr double kOwnLength = 0.010;
// The same in addition for each single view: a tracker's error depends on its point of view.
constexpr double kOwnInOneView = 0.036;
// Of the sizes of different people.
constexpr double kOthersSize = 0.050;
// Of the lengths of different people of the same size.
constexpr double kOthersLength = 0.020;
// Variance of the size, relative to that of a mean of as many independent errors.
constexpr double kSizeShare = 0.5;
constexpr double kLongMean = 60.0;  // [s] of a Repeatability
constexpr double kMostOff = 50.0;   // A second that is farther off counts as this much.
// The mean of a length over a time in view varies less the longer that is: its variance is the sum
// of these shares; errors last for kErrorTime [s], except for those that stay, and those of a
// frame.
constexpr double kLastingShare = 0.35;
constexpr double kSlowShare = 1.7;
constexpr double kErrorTime = 1.5;
constexpr double kFrameShare = 0.1;  // [s]

struct Mean {
  double sum = 0.0;
  double count = 0.0;
  void add(double value) {
    sum += value;
    count += 1.0;
  }
};

void add_length(Mean& mean, const Located& body, const std::array<JointId, 2>& ends) {
  const auto& from = body[index_of(ends[0])];
  const auto& to = body[index_of(ends[1])];
  if (!from || !to) return;
  const double length = (*from - *to).norm();
  if (length > 0) mean.add(std::log(length));
}

void add_lengths(std::array<Mean, kSpans>& means, const Located& body) {
  for (std::size_t i = 0; i < kSpans; ++i) {
    add_length(means[i], body, kSpanTable[i].left);
    if (kSpanTable[i].right != kSpanTable[i].left) add_length(means[i], body, kSpanTable[i].right);
  }
}

Located tracked_points(const Skeleton<WorldSpace>& body) {
  Located points;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Joint& joint = body.joints[i];
    if (joint.seen() && joint.state == JointState::Tracked) points[i] = joint.position;
  }
  return points;
}

double variance_of(const Build& build, std::size_t span) {
  const double by_views = square(kOwnInOneView) / std::max(1.0, build.views);
  const double time = build.sight[span];
  const double by_time =
      kLastingShare + kSlowShare / (1.0 + time / kErrorTime) + kFrameShare / time;
  return (square(kOwnLength) + by_views) * by_time;
}

struct Difference {
  double count = 0.0;  ///< Number of lengths that both have.
  double own = 0.0;    ///< Variance of the difference of a length if the two are one person.
  double size = 0.0;   ///< Weighted mean over the lengths [ln m].
  double rest = 0.0;   ///< Sum of the squared differences from that mean.
};

bool in_both(const StatedBuild& one, const StatedBuild& other, std::size_t span) {
  return one.variance[span] > 0 && other.variance[span] > 0;
}

Difference difference(const StatedBuild& one, const StatedBuild& other) {
  Difference all;
  double weights = 0.0;
  for (std::size_t i = 0; i < kSpans; ++i) {
    if (!in_both(one, other, i)) continue;
    all.count += 1.0;
    all.own += one.variance[i] + other.variance[i];
    all.size += kSpanTable[i].weight * (one.mean[i] - other.mean[i]);
    weights += kSpanTable[i].weight;
  }
  if (all.count == 0.0) return all;
  all.own /= all.count;
  all.size /= weights;
  for (std::size_t i = 0; i < kSpans; ++i) {
    if (in_both(one, other, i)) all.rest += square(one.mean[i] - other.mean[i] - all.size);
  }
  return all;
}

/// Log likelihood ratio of `variance` against `variance` + `more`, for `count` normal deviations
/// with this sum of squares.
double odds_of(double squares, double count, double variance, double more) {
  const double larger = variance + more;
  return 0.5 * (count * std::log(larger / variance) - squares / variance + squares / larger);
}

}  // namespace

Spans spans_of(std::span<const PlacedView> views, const Located& met) {
  std::array<Mean, kSpans> means;
  for (const PlacedView& each : views) {
    if (!each.rays) add_lengths(means, tracked_points(each.view.skeleton));
  }
  if (std::ranges::all_of(views, &PlacedView::rays)) add_lengths(means, met);
  Spans spans;
  const auto points = std::ranges::count(views, false, &PlacedView::rays);
  spans.views = static_cast<double>(points > 0 ? points : std::ssize(views));
  for (std::size_t i = 0; i < kSpans; ++i) {
    if (means[i].count > 0) spans.length[i] = means[i].sum / means[i].count;
  }
  return spans;
}

Spans spans_of(const Located& body, double views) {
  std::array<Mean, kSpans> means;
  add_lengths(means, body);
  Spans spans;
  spans.views = views;
  for (std::size_t i = 0; i < kSpans; ++i) {
    if (means[i].count > 0) spans.length[i] = means[i].sum / means[i].count;
  }
  return spans;
}

void Build::add(const Spans& spans, double elapsed) {
  Build now;
  now.views = spans.views;
  for (std::size_t i = 0; i < kSpans; ++i) {
    if (!spans.length[i]) continue;
    now.mean[i] = *spans.length[i];
    now.sight[i] = elapsed;
  }
  add(now);
}

void Build::add(const Build& other) {
  const double known = sight_of(*this);
  const double news = sight_of(other);
  if (known + news > 0) views = (known * views + news * other.views) / (known + news);
  for (std::size_t i = 0; i < kSpans; ++i) {
    const double both = sight[i] + other.sight[i];
    if (!(other.sight[i] > 0)) continue;
    mean[i] += other.sight[i] / both * (other.mean[i] - mean[i]);
    sight[i] = std::min(both, kMostSight);
  }
}

double sight_of(const Build& build) {
  std::array<double, kSpans> sight = build.sight;
  std::ranges::nth_element(sight, sight.begin() + kSpans / 2);
  return sight[kSpans / 2];
}

StatedBuild stated(const Build& build) {
  StatedBuild all;
  all.mean = build.mean;
  for (std::size_t i = 0; i < kSpans; ++i) {
    if (build.sight[i] > 0) all.variance[i] = variance_of(build, i);
  }
  return all;
}

void Repeatability::learn(const Build& now, const Build& usual) {
  learn(stated(now), stated(usual));
}

void Repeatability::learn(const StatedBuild& now, const StatedBuild& usual) {
  const Difference off = difference(now, usual);
  if (off.count < 2.0) return;
  seconds = std::min(seconds + 1.0, kLongMean);
  const auto follow = [&](double& ratio, double squares, double expected) {
    ratio += (std::min(squares / expected, kMostOff) - ratio) / seconds;
    ratio = std::max(1.0, ratio);
  };
  follow(size, square(off.size), kSizeShare * off.own / off.count);
  follow(lengths, off.rest, (off.count - 1.0) * off.own);
}

double likeness(const Build& one, const Build& other, const Repeatability& repeatability) {
  return likeness(stated(one), stated(other), repeatability);
}

double likeness(const StatedBuild& one, const StatedBuild& other,
                const Repeatability& repeatability) {
  const Difference off = difference(one, other);
  if (!(off.count > 0)) return 0.0;
  const double own_size = repeatability.size * kSizeShare * off.own / off.count;
  const double own_length = repeatability.lengths * off.own;
  return odds_of(square(off.size), 1.0, own_size, 2.0 * square(kOthersSize)) +
         odds_of(off.rest, off.count - 1.0, own_length, 2.0 * square(kOthersLength));
}

}  // namespace chorus::associate
