#include "common/positioning/clock_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/median.h"
#include "common/geometry/rotation.h"
#include "common/positioning/landmark_fit.h"

namespace chorus::positioning {
namespace {

constexpr double kCoarse = 0.05;        // Steps of the first search [s].
constexpr double kFine = 0.005;         // Of the second [s].
constexpr double kAround = 0.1;         // Reach of the second to each side [s].
constexpr std::size_t kPictures = 120;  // Pictures that a search uses, spread over the take.
// The best offset must fit better than the median of all by this share, or the take says nothing
// about the clock: a person who stands still fits at any time.
constexpr double kTelling = 0.93;
constexpr double kHeadingSigma = 0.15;  // Of a heading that is tried [rad].
// Cameras are on one clock if their offsets differ by less than so many standard deviations.
constexpr double kAgree = 3.0;

struct Pictured {
  const CameraTake* camera;
  const SensorFrame* frame;
  double time;  ///< Of the suit, as far as the camera's clock is known [s].
};

void add_pictures(const CameraTake& camera, Timestamp start, double offset,
                  std::vector<Pictured>& out) {
  for (const SensorFrame& frame : camera.frames) {
    if (!frame.bodies.empty())
      out.push_back({&camera, &frame, seconds(frame.captured - start) - offset});
  }
}

std::vector<Pictured> spread(const std::vector<Pictured>& all) {
  std::vector<Pictured> out;
  const std::size_t step = 1 + all.size() / kPictures;
  for (std::size_t i = 0; i < all.size(); i += step) out.push_back(all[i]);
  return out;
}

std::vector<Pictured> pictures_of(const CameraTake& camera, Timestamp start) {
  std::vector<Pictured> all;
  add_pictures(camera, start, 0.0, all);
  return spread(all);
}

std::vector<Pictured> pictures_of(std::span<const CameraTake> cameras, Timestamp start,
                                  const std::vector<ClockFit>& clocks) {
  std::vector<Pictured> all;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    add_pictures(cameras[i], start, clocks[i].offset, all);
  return spread(all);
}

/// The misfit of all pictures together at an offset that is added to what is known; a picture
/// without a fit counts as ill-fitting.
double misfit_at(const std::vector<Pictured>& pictures, const suit::SuitTake& suit, double offset,
                 double heading) {
  double sum = 0.0;
  for (const Pictured& one : pictures) {
    const suit::SuitPose pose = pose_at(suit, from_seconds(one.time - offset));
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
                       double offset, double heading) {
  double by = 0.0;
  double weights = 0.0;
  for (const Pictured& one : pictures) {
    const suit::SuitPose pose = pose_at(suit, from_seconds(one.time - offset));
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
                  double offset) {
  std::vector<Pictured> some;
  for (std::size_t i = 0; i < pictures.size(); i += 4) some.push_back(pictures[i]);
  constexpr int kHeadings = 24;
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kHeadings; ++i) {
    const double heading = wrap_angle(2.0 * std::numbers::pi * i / kHeadings);
    const double misfit = misfit_at(some, suit, offset, heading);
    if (misfit >= least) continue;
    least = misfit;
    best = heading;
  }
  // The fits of single pictures stay near the heading that is tried.
  constexpr int kRefinements = 4;
  for (int i = 0; i < kRefinements; ++i) best = refined_heading(some, suit, offset, best);
  return best;
}

struct Tried {
  double offset;
  double misfit;
};

struct Range {
  double from, to, step;  ///< [s]
};

std::vector<Tried> tried(const std::vector<Pictured>& pictures, const suit::SuitTake& suit,
                         const Range& range, double heading) {
  std::vector<Tried> out;
  for (double offset = range.from; offset <= range.to + 1e-9; offset += range.step)
    out.push_back({offset, misfit_at(pictures, suit, offset, heading)});
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

/// One camera, while it is looked for.
struct Searched {
  std::vector<Pictured> pictures;
  double usual = 0.0;  ///< Misfit, the median over all offsets.
};

/// The best of all offsets, at the heading that fits best in their middle.
ClockFit rough_clock(const suit::SuitTake& suit, const ClockSearch& search, Searched& camera) {
  ClockFit out;
  out.sigma = search.farthest_s;
  if (camera.pictures.empty()) return out;
  const double heading = heading_at(camera.pictures, suit, 0.0);
  const auto all =
      tried(camera.pictures, suit, {-search.farthest_s, search.farthest_s, kCoarse}, heading);
  camera.usual = median_of(all);
  out.offset = best_of(all).offset;
  out.at_edge = std::abs(out.offset) > search.farthest_s - 1.5 * kCoarse;
  return out;
}

void refine_clock(const suit::SuitTake& suit, const Searched& camera, double heading,
                  ClockFit& clock) {
  if (camera.pictures.empty()) return;
  const auto all = tried(camera.pictures, suit,
                         {clock.offset - kAround, clock.offset + kAround, kFine}, heading);
  const Tried best = best_of(all);
  clock.offset = best.offset;
  clock.misfit = best.misfit;
  clock.found = best.misfit < kTelling * camera.usual && best.misfit < kLargestMisfit;
  if (clock.found) sharpen(all, camera.pictures.size(), clock);
}

/// Cameras that agree with the one that is most certain get the mean of what they say, and so on
/// with those that are left.  Cameras that tell nothing get what the most say.
void share_clocks(std::vector<ClockFit>& clocks) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < clocks.size(); ++i)
    if (clocks[i].found) left.push_back(i);
  std::ranges::sort(left, {}, [&](std::size_t i) { return clocks[i].sigma; });
  double usual = 0.0;
  std::size_t most = 0;
  while (!left.empty()) {
    const ClockFit surest = clocks[left.front()];
    const auto apart = std::ranges::stable_partition(left, [&](std::size_t i) {
      return std::abs(clocks[i].offset - surest.offset) <=
             kAgree * std::hypot(clocks[i].sigma, surest.sigma);
    });
    const std::vector<std::size_t> together(left.begin(), apart.begin());
    left.assign(apart.begin(), apart.end());
    double sum = 0.0;
    double weights = 0.0;
    for (const std::size_t i : together) {
      const double weight = 1.0 / std::max(1e-12, clocks[i].sigma * clocks[i].sigma);
      sum += weight * clocks[i].offset;
      weights += weight;
    }
    for (const std::size_t i : together) {
      clocks[i].offset = sum / weights;
      clocks[i].sigma = 1.0 / std::sqrt(weights);
    }
    if (together.size() > most) most = together.size(), usual = sum / weights;
  }
  for (ClockFit& clock : clocks)
    if (!clock.found) clock.offset = usual;
}

}  // namespace

ClockFits fit_clocks(std::span<const CameraTake> cameras, const suit::SuitTake& suit,
                     const ClockSearch& search) {
  ClockFits out;
  std::vector<Searched> searched;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    searched.push_back({pictures_of(cameras[i], search.start)});
    out.cameras.push_back(i == 0 && search.offset_s
                              ? ClockFit{*search.offset_s, 0.0, 0.0, true, false}
                              : rough_clock(suit, search, searched.back()));
  }
  const auto heading = [&] {
    return heading_at(pictures_of(cameras, search.start, out.cameras), suit, 0.0);
  };
  out.heading = heading();
  for (std::size_t i = search.offset_s ? 1 : 0; i < cameras.size(); ++i)
    refine_clock(suit, searched[i], out.heading, out.cameras[i]);
  share_clocks(out.cameras);
  if (cameras.size() > 1 || !search.offset_s) out.heading = heading();
  return out;
}

}  // namespace chorus::positioning
