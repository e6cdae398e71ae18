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

/// By the first camera's clock.
Timestamp captured(const SensorFrame& frame, const ClockFits& clocks, std::size_t camera) {
  return frame.captured - from_seconds(clocks.ahead(camera));
}

struct Looks {
  std::vector<std::size_t> next;  ///< Of each camera, the first frame that was not used.
};

/// The pictures since the last instant; a camera faster than the answer gives its latest.
std::vector<Look> looks_until(std::span<const CameraTake> cameras, const ClockFits& clocks,
                              Timestamp until, Looks& done) {
  std::vector<Look> out;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::vector<SensorFrame>& frames = cameras[i].frames;
    const std::size_t first = done.next[i];
    std::size_t next = first;
    while (next < frames.size() && captured(frames[next], clocks, i) <= until) ++next;
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

Result<Span> span_of(std::span<const CameraTake> cameras, const ClockFits& clocks) {
  std::optional<Span> span;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (const SensorFrame& frame : cameras[i].frames) {
      const Timestamp at = captured(frame, clocks, i);
      if (!span) span = Span{at, at};
      span->first = std::min(span->first, at);
      span->last = std::max(span->last, at);
    }
  }
  if (!span) return fail(ErrorCode::InvalidArgument, "cameras", "they have no pictures");
  return *span;
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
                     double offset) {
  constexpr double kLeastOverlap = 0.5;  // Of the cameras' time.
  constexpr double kLeast = 0.1;         // [s]
  if (suit.poses.empty()) return fail(ErrorCode::InvalidArgument, "suit", "it has no poses");
  const double from = std::max(seconds(span.first - settings.clocks.start),
                               seconds(suit.poses.front().time) + offset);
  const double to = std::min(seconds(span.last - settings.clocks.start),
                             seconds(suit.poses.back().time) + offset);
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

/// With the heading that the pictures show, if it is not stated and somebody is in one.
TrackerSettings tracking_of(std::span<const CameraTake> cameras, const TakeSettings& settings,
                            const ClockFits& clocks) {
  TrackerSettings out = settings.tracker;
  out.cameras = cameras.size();
  const bool somebody = std::ranges::any_of(cameras, [](const CameraTake& camera) {
    return std::ranges::any_of(camera.frames,
                               [](const SensorFrame& frame) { return !frame.bodies.empty(); });
  });
  if (!out.heading && somebody) out.heading = clocks.heading;
  return out;
}

}  // namespace

Result<TakeResult> place_take(std::span<const CameraTake> cameras, const suit::SuitTake& suit,
                              const TakeSettings& settings,
                              const std::function<void(double)>& progress) {
  TakeResult result;
  result.clocks = fit_clocks(cameras, suit, settings.clocks);
  const auto span = span_of(cameras, result.clocks);
  if (!span) return pass(span);
  const double offset = result.clocks.cameras.front().offset;
  if (const auto ok = overlap(*span, suit, settings, offset); !ok) return pass(ok);
  const TrackerSettings tracking = tracking_of(cameras, settings, result.clocks);
  Tracker tracker(tracking);
  Looks done{std::vector<std::size_t>(cameras.size(), 0)};
  std::vector<FilterStep> steps;
  const Duration period = from_seconds(1.0 / settings.rate_hz);
  // Half a period: a picture belongs to the nearest instant.
  for (Timestamp now = span->first; now <= span->last + period / 2; now += period) {
    const double at = seconds(now - settings.clocks.start) - offset;
    Instant instant{pose_at(suit, from_seconds(at)),
                    looks_until(cameras, result.clocks, now + period / 2, done)};
    instant.pose.time = now - settings.clocks.start;
    result.pictures += instant.looks.size();
    ++result.instants;
    if (!has_pose(suit, at)) {
      ++result.without_suit;
      continue;
    }
    const auto tracked = tracker.next(instant);
    if (progress) progress(seconds(now - span->first) / seconds(span->last - span->first + period));
    if (!tracked) continue;
    result.placed.push_back(
        {now - settings.clocks.start, instant.pose, *tracked, tracked->position});
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
