#include "common/positioning/take.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/geometry/rotation.h"
#include "common/positioning/paper_smoothing.h"

namespace chorus::positioning {
namespace {

constexpr double kCoarse = 0.05;        // Steps of the first search [s].
constexpr double kFine = 0.005;         // Of the second [s].
constexpr std::size_t kPictures = 120;  // Pictures that the search uses, spread over the take.
// The best offset must fit better than the median of all by this share, or the take says nothing
// about the clock: a person who stands still fits at any time.
constexpr double kTelling = 0.93;
constexpr double kHeadingSigma = 0.15;  // Of a heading that is tried [rad].

struct Pictured {
  const CameraTake* camera;
  const SensorFrame* frame;
};

std::vector<Pictured> spread(std::span<const CameraTake> cameras) {
  std::vector<Pictured> all;
  for (const CameraTake& camera : cameras) {
    for (const SensorFrame& frame : camera.frames) {
      if (!frame.bodies.empty()) all.push_back({&camera, &frame});
    }
  }
  std::vector<Pictured> out;
  const std::size_t step = 1 + all.size() / kPictures;
  for (std::size_t i = 0; i < all.size(); i += step) out.push_back(all[i]);
  return out;
}

/// The misfit at each offset for each picture; a picture without a fit counts as ill-fitting.
double misfit_at(const std::vector<Pictured>& pictures, const suit::SuitTake& suit,
                 const TakeSettings& settings, double offset, double heading) {
  double sum = 0.0;
  for (const Pictured& one : pictures) {
    const double at = seconds(one.frame->captured - settings.start) - offset;
    const suit::SuitPose pose = pose_at(suit, from_seconds(at));
    double best = 2.0 * kLargestMisfit;
    for (const BodyFrame& body : one.frame->bodies) {
      const std::array<SeenRays, 1> rays{SeenRays{one.camera->world_from_sensor, body.skeleton}};
      const auto fit = fit_landmarks(rays, pose, {heading, kHeadingSigma});
      if (fit) best = std::min(best, fit->misfit);
    }
    sum += best * best;
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, pictures.size())));
}

/// The mean of the headings that the pictures find near this one.
double refined_heading(const std::vector<Pictured>& pictures, const suit::SuitTake& suit,
                       const TakeSettings& settings, double offset, double heading) {
  double by = 0.0;
  double weights = 0.0;
  for (const Pictured& one : pictures) {
    const double at = seconds(one.frame->captured - settings.start) - offset;
    const suit::SuitPose pose = pose_at(suit, from_seconds(at));
    for (const BodyFrame& body : one.frame->bodies) {
      const std::array<SeenRays, 1> rays{SeenRays{one.camera->world_from_sensor, body.skeleton}};
      const auto fit = fit_landmarks(rays, pose, {heading, kHeadingSigma});
      if (!fit) continue;
      const double weight = 1.0 / std::pow(std::max(0.3, fit->misfit), 4);
      by += weight * wrap_angle(fit->heading - heading);
      weights += weight;
    }
  }
  return weights > 0.0 ? wrap_angle(heading + by / weights) : heading;
}

/// The heading at which the pictures fit best together, at this offset of the clocks.  Pictures in
/// which the network exchanged left and right fit best at the opposite one: a mean over the best
/// heading of each picture would lie between the two.
double heading_at(const std::vector<Pictured>& pictures, const suit::SuitTake& suit,
                  const TakeSettings& settings, double offset) {
  std::vector<Pictured> some;
  for (std::size_t i = 0; i < pictures.size(); i += 4) some.push_back(pictures[i]);
  constexpr int kHeadings = 24;
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kHeadings; ++i) {
    const double heading = wrap_angle(2.0 * std::numbers::pi * i / kHeadings);
    const double misfit = misfit_at(some, suit, settings, offset, heading);
    if (misfit >= least) continue;
    least = misfit;
    best = heading;
  }
  // The fits of single pictures stay near the heading that is tried.
  constexpr int kRefinements = 4;
  for (int i = 0; i < kRefinements; ++i) best = refined_heading(some, suit, settings, offset, best);
  return best;
}

struct Tried {
  double offset;
  double misfit;
};

std::vector<Tried> tried(const std::vector<Pictured>& pictures, const suit::SuitTake& suit,
                         const TakeSettings& settings, double from, double to) {
  const bool fine = to - from < 0.3;
  const double step = fine ? kFine : kCoarse;
  const double heading = heading_at(pictures, suit, settings, 0.5 * (from + to));
  std::vector<Tried> out;
  for (double offset = from; offset <= to + 1e-9; offset += step)
    out.push_back({offset, misfit_at(pictures, suit, settings, offset, heading)});
  return out;
}

const Tried& best_of(const std::vector<Tried>& all) {
  return *std::min_element(all.begin(), all.end(),
                           [](const Tried& a, const Tried& b) { return a.misfit < b.misfit; });
}

double median_of(const std::vector<Tried>& all) {
  std::vector<double> values;
  for (const Tried& one : all) values.push_back(one.misfit);
  return median(std::move(values));
}

/// The lowest point of the parabola through the best offset and its neighbours; its curvature tells
/// the standard deviation.
void sharpen(const std::vector<Tried>& all, std::size_t pictures, ClockFit& out) {
  const auto best = static_cast<std::size_t>(&best_of(all) - all.data());
  constexpr std::size_t kReach = 6;  // 30 ms to each side: less, and noise decides.
  if (best < kReach || best + kReach >= all.size()) return;
  const auto squares = [&](std::size_t i) { return all[i].misfit * all[i].misfit; };
  const double left = squares(best - kReach);
  const double right = squares(best + kReach);
  const double curvature = left + right - 2.0 * squares(best);
  if (!(curvature > 0.0)) return;
  const double width = static_cast<double>(kReach) * kFine;
  out.offset += std::clamp(0.5 * width * (left - right) / curvature, -width, width);
  // chi^2 of all residuals (about 20 a picture, of which one in ten is independent).
  const double independent = 2.0 * static_cast<double>(pictures);
  out.sigma = width / std::sqrt(std::max(
                          1e-9, 0.5 * independent * curvature / std::max(0.05, squares(best))));
}

struct Looks {
  std::vector<std::size_t> next;  ///< Of each camera, the first frame that was not used.
};

/// The pictures since the last instant; a camera faster than the answer gives its latest.
std::vector<Look> looks_until(std::span<const CameraTake> cameras, Timestamp until, Looks& done) {
  std::vector<Look> out;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::vector<SensorFrame>& frames = cameras[i].frames;
    const std::size_t first = done.next[i];
    std::size_t next = first;
    while (next < frames.size() && frames[next].captured <= until) ++next;
    done.next[i] = next;
    if (next == first) continue;
    Look look{i, cameras[i].world_from_sensor, {}, {}};
    for (const BodyFrame& body : frames[next - 1].bodies) look.people.push_back(body.skeleton);
    if (cameras[i].sight) look.sight = cameras[i].sight(next - 1);
    out.push_back(std::move(look));
  }
  return out;
}

struct Span {
  Timestamp first;
  Timestamp last;
};

Result<Span> span_of(std::span<const CameraTake> cameras) {
  std::optional<Span> span;
  for (const CameraTake& camera : cameras) {
    for (const SensorFrame& frame : camera.frames) {
      if (!span) span = Span{frame.captured, frame.captured};
      span->first = std::min(span->first, frame.captured);
      span->last = std::max(span->last, frame.captured);
    }
  }
  if (!span) return fail(ErrorCode::InvalidArgument, "cameras", "they have no pictures");
  return *span;
}

/// The stated offset, or the one that landmarks show.
ClockFit clock_of(std::span<const CameraTake> cameras, const suit::SuitTake& suit,
                  const TakeSettings& settings) {
  if (!settings.offset_s) {
    ClockFit found = fit_clock(cameras, suit, settings);
    if (!found.found) found.offset = 0.0;
    return found;
  }
  ClockFit stated{*settings.offset_s, 0.0, 0.0, true, 0.0};
  stated.heading = heading_at(spread(cameras), suit, settings, *settings.offset_s);
  return stated;
}

/// Whether the suit's take has a pose for this time of its own, or one that is as good.
bool has_pose(const suit::SuitTake& suit, double at) {
  constexpr double kNearly = 0.1;  // [s]
  return at > seconds(suit.poses.front().time) - kNearly &&
         at < seconds(suit.poses.back().time) + kNearly;
}

double median_misfit(const TakeResult& result) {
  std::vector<double> misfits;
  for (const Placed& one : result.placed)
    if (one.online.misfit > 0.0) misfits.push_back(one.online.misfit);
  return misfits.empty() ? 0.0 : median(std::move(misfits));
}

/// Refuses a suit's take that has no pose for most of the cameras' time: it would stand still.
Result<void> overlap(const Span& span, const suit::SuitTake& suit, const TakeSettings& settings,
                     const ClockFit& clock) {
  constexpr double kLeastOverlap = 0.5;  // Of the cameras' time.
  constexpr double kLeast = 0.1;         // [s]
  if (suit.poses.empty()) return fail(ErrorCode::InvalidArgument, "suit", "it has no poses");
  const double from = std::max(seconds(span.first - settings.start),
                               seconds(suit.poses.front().time) + clock.offset);
  const double to =
      std::min(seconds(span.last - settings.start), seconds(suit.poses.back().time) + clock.offset);
  const double length = std::max(kLeast, seconds(span.last - span.first));
  if (to - from + kLeast >= kLeastOverlap * length) return {};
  return fail(
      ErrorCode::InvalidArgument, "suit",
      fmt::format("its take covers {:.1f} s of the cameras' {:.1f} s: is it the right take, "
                  "and its clock that of the videos? --clock-offset states the difference, "
                  "--search looks for a larger one",
                  std::max(0.0, to - from), length));
}

void smooth(const std::vector<FilterStep>& steps, Method method, TakeResult& result) {
  if (method == Method::Silhouettes) {
    gauss_smooth(result.placed);
    return;
  }
  const std::vector<Position> all = smoothed(steps);
  for (std::size_t i = 0; i < std::min(all.size(), result.placed.size()); ++i)
    result.placed[i].smooth = all[i];
}

Result<void> check(const TakeResult& result, std::span<const CameraTake> cameras, Method method) {
  if (!result.placed.empty()) return {};
  const std::string& name = cameras.front().sensor.str();
  std::size_t somebody = 0;
  bool looked = false;
  for (const CameraTake& camera : cameras) {
    looked = looked || camera.sight;
    for (const SensorFrame& frame : camera.frames) somebody += frame.bodies.empty() ? 0 : 1;
  }
  if (somebody > 0)
    return fail(
        ErrorCode::InvalidArgument, name,
        fmt::format("somebody is in {} pictures, but nobody moves as the suit says: "
                    "another person, another take, clocks farther apart than was tried, or a "
                    "file whose upward axis is not y",
                    somebody));
  return fail(ErrorCode::InvalidArgument, name,
              !looked || uses_landmarks(method)
                  ? "nobody is seen in any picture"
                  : "nobody is seen in any picture whose outline is the suit's; is the room "
                    "without the person known (--empty-room), and the suit's heading?");
}

/// What the whole take tells of the suit's heading and of each camera's depths.
void conclude(const Tracker& tracker, std::size_t cameras, TakeResult& result) {
  result.misfit = median_misfit(result);
  const Position end = result.placed.back().smooth;
  result.heading = end.heading;
  result.heading_sigma = end.heading_sigma;
  for (std::size_t i = 0; i < cameras; ++i) result.depth.push_back(tracker.filter().depth_of(i));
}

}  // namespace

ClockFit fit_clock(std::span<const CameraTake> cameras, const suit::SuitTake& suit,
                   const TakeSettings& settings) {
  const std::vector<Pictured> pictures = spread(cameras);
  ClockFit out;
  if (pictures.empty()) return out;
  const auto coarse = tried(pictures, suit, settings, -settings.farthest_s, settings.farthest_s);
  const Tried rough = best_of(coarse);
  constexpr double kAround = 0.1;  // [s]
  const auto fine = tried(pictures, suit, settings, rough.offset - kAround, rough.offset + kAround);
  const Tried best = best_of(fine);
  out.offset = best.offset;
  out.misfit = best.misfit;
  out.sigma = settings.farthest_s;
  out.at_edge = std::abs(rough.offset) > settings.farthest_s - 1.5 * kCoarse;
  out.found = best.misfit < kTelling * median_of(coarse) && best.misfit < kLargestMisfit;
  if (out.found) sharpen(fine, pictures.size(), out);
  out.heading = heading_at(pictures, suit, settings, out.found ? out.offset : 0.0);
  return out;
}

Result<TakeResult> place_take(std::span<const CameraTake> cameras, const suit::SuitTake& suit,
                              const TakeSettings& settings,
                              const std::function<void(double)>& progress) {
  const auto span = span_of(cameras);
  if (!span) return pass(span);
  TakeResult result;
  result.clock = clock_of(cameras, suit, settings);
  if (const auto ok = overlap(*span, suit, settings, result.clock); !ok) return pass(ok);
  TrackerSettings tracking = settings.tracker;
  tracking.cameras = cameras.size();
  if (!tracking.heading && !spread(cameras).empty()) tracking.heading = result.clock.heading;
  Tracker tracker(tracking);
  Looks done{std::vector<std::size_t>(cameras.size(), 0)};
  std::vector<FilterStep> steps;
  const Duration period = from_seconds(1.0 / settings.rate_hz);
  // Half a period: a picture belongs to the nearest instant.
  for (Timestamp now = span->first; now <= span->last + period / 2; now += period) {
    const double at = seconds(now - settings.start) - result.clock.offset;
    Instant instant{pose_at(suit, from_seconds(at)), looks_until(cameras, now + period / 2, done)};
    instant.pose.time = now - settings.start;
    result.pictures += instant.looks.size();
    ++result.instants;
    if (!has_pose(suit, at)) {
      ++result.without_suit;
      continue;
    }
    const auto tracked = tracker.next(instant);
    if (progress) progress(seconds(now - span->first) / seconds(span->last - span->first + period));
    if (!tracked) continue;
    result.placed.push_back({now - settings.start, instant.pose, *tracked, tracked->position});
    result.ambiguous += tracked->ambiguous ? 1 : 0;
    if (tracker.filter().begun()) steps.push_back(tracker.filter().step());
  }
  result.strangers = tracker.strangers();
  if (const auto ok = check(result, cameras, tracking.method); !ok) return pass(ok);
  smooth(steps, tracking.method, result);
  conclude(tracker, steps.empty() ? 0 : cameras.size(), result);
  return result;
}

}  // namespace chorus::positioning
