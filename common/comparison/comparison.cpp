#include "common/comparison/comparison.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "common/alignment/trajectory_alignment.h"
#include "common/base/median.h"
#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/body/located.h"
#include "common/comparison/blocks.h"
#include "common/geometry/rigid_fit.h"

namespace chorus::comparison {
namespace {

constexpr double kSamePerson = 0.5;           // Largest median distance of trunks [m].
constexpr std::size_t kMostFitPoints = 4000;  // Of the rigid transform.
constexpr std::size_t kFewestFrames = 10;
constexpr double kMinute = 60.0;
/// A lag of less than this is below what frames and interpolation show [s].
constexpr double kLeastLag = 0.002;

struct Both {
  double time = 0.0;
  Located a;
  Located b;
};

std::string who(const char* side) { return std::string("recording ") + side; }

Result<void> checked(const People& people, const char* side) {
  if (people.empty()) return fail(ErrorCode::NotFound, who(side), "shows nobody");
  for (const auto& [id, track] : people) {
    const bool ordered = std::ranges::is_sorted(track, {}, &Moment::time);
    if (!ordered)
      return fail(ErrorCode::InvalidArgument, who(side),
                  fmt::format("person {}: times go back", id));
  }
  return {};
}

const std::pair<const std::uint64_t, Track>& longest(const People& people) {
  return *std::ranges::max_element(people, {}, [](const auto& each) { return each.second.size(); });
}

alignment::Trace trace_of(const Track& track) {
  alignment::Trace trace;
  for (const Moment& moment : track) {
    if (const auto middle = middle_of(points_of(moment.body)))
      trace.push_back({moment.time, *middle, {}});
  }
  return trace;
}

/// B's joints at a time of B; those that either neighbour lacks are left out.
std::optional<Located> at(const Track& track, double time, double max_gap) {
  const auto after = std::ranges::lower_bound(track, time, {}, &Moment::time);
  if (after == track.end()) return std::nullopt;
  if (after->time == time) return points_of(after->body);
  if (after == track.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (after->time - before->time > max_gap) return std::nullopt;
  const double part = (time - before->time) / (after->time - before->time);
  Located from = points_of(before->body);
  const Located to = points_of(after->body);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (from[j] && to[j])
      *from[j] += part * (*to[j] - *from[j]);
    else
      from[j].reset();
  }
  return from;
}

std::vector<Both> together(const Track& a, const Track& b, double lag, double max_gap) {
  std::vector<Both> out;
  for (const Moment& moment : a) {
    if (auto other = at(b, moment.time - lag, max_gap))
      out.push_back({moment.time, points_of(moment.body), std::move(*other)});
  }
  return out;
}

Located moved(const Located& joints, const Eigen::Isometry3d& a_from_b) {
  Located out = joints;
  for (auto& joint : out)
    if (joint) joint = a_from_b * *joint;
  return out;
}

struct Fit {
  double lag = 0.0;
  std::optional<double> lag_sigma;
  Eigen::Isometry3d a_from_b = Eigen::Isometry3d::Identity();
};

/// The alignment's own words name options of another command.
Result<void> check_overlap(const Track& a, const Track& b, const CompareOptions& options) {
  if (!options.clock_range || a.empty() || b.empty()) return {};
  const double from = std::max(a.front().time, b.front().time);
  const double to = std::min(a.back().time, b.back().time);
  if (to + *options.clock_range >= from) return {};
  return fail(
      ErrorCode::NotFound, "comparison",
      fmt::format("the two share no time: B {} {:.0f} s {}. If their clocks have nothing in "
                  "common, say --any-lag",
                  b.front().time > a.front().time ? "begins" : "ends", from - to,
                  b.front().time > a.front().time ? "after A ends" : "before A begins"));
}

Result<void> find_lag(const Track& a, const Track& b, const CompareOptions& options, Fit& fit) {
  if (options.same_clock) return {};
  alignment::AlignmentConfig config;
  config.clock_range = options.clock_range;
  config.max_gap = options.max_gap;
  const auto found = alignment::align_traces(trace_of(a), trace_of(b), config);
  if (!found) {
    std::string why = found.error().message;
    for (const char* of_clock : {" Their clocks may differ", ", or narrow --clock"})
      why.resize(std::min(why.size(), why.find(of_clock)));  // --clock is not ours
    if (!why.ends_with('?')) why += '.';
    why += " If both have one clock, say --same-clock";
    if (options.clock_range) why += "; if their clocks have nothing in common, say --any-lag";
    return fail(found.error().code, "lag", std::move(why));
  }
  fit.lag = found->clock_offset;
  fit.lag_sigma = found->clock_sigma;
  return {};
}

Result<void> find_transform(const std::vector<Both>& frames, Fit& fit) {
  std::vector<Eigen::Vector3d> ours;
  std::vector<Eigen::Vector3d> theirs;
  const std::size_t step = 1 + frames.size() * kJointCount / kMostFitPoints;
  for (std::size_t i = 0; i < frames.size(); i += step) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!frames[i].a[j] || !frames[i].b[j]) continue;
      ours.push_back(*frames[i].a[j]);
      theirs.push_back(*frames[i].b[j]);
    }
  }
  const auto rigid = fit_rigid(theirs, ours);
  if (!rigid) return fail(ErrorCode::NotFound, "transform", "too few joints that both see");
  fit.a_from_b = rigid->target_from_source;
  return {};
}

/// By how much A's body is turned against B's about +y, from joints that both see [rad].
std::optional<double> turn_between(const Both& frame) {
  std::vector<Eigen::Vector3d> ours;
  std::vector<Eigen::Vector3d> theirs;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!frame.a[j] || !frame.b[j]) continue;
    ours.push_back(*frame.a[j]);
    theirs.push_back(*frame.b[j]);
  }
  const auto fit = fit_yaw(theirs, ours);
  if (!fit) return std::nullopt;
  const Eigen::Vector3d z = fit->target_from_source.linear().col(2);
  return std::atan2(z.x(), z.z());
}

std::optional<Eigen::Vector3d> apart(const Both& frame) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const JointId id : kCoreJoints) {
    const auto& a = frame.a[index_of(id)];
    const auto& b = frame.b[index_of(id)];
    if (!a || !b) continue;
    sum += *a - *b;
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return Eigen::Vector3d(sum / count);
}

/// Level of one question such that all of them together have the asked one.
double level(const CompareOptions& options) {
  constexpr double kQuestions = 3.0 * kJointCount + 5.0;
  return 1.0 - (1.0 - options.confidence) / kQuestions;
}

void compare_worlds(const std::vector<Both>& frames, const CompareOptions& options,
                    Comparison& out) {
  Series yaw;
  std::array<Series, 3> offset;
  for (const Both& frame : frames) {
    if (const auto turn = turn_between(frame)) {
      yaw.times.push_back(frame.time);
      yaw.values.push_back(*turn);
    }
    const auto between = apart(frame);
    if (!between) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      offset[axis].times.push_back(frame.time);
      offset[axis].values.push_back((*between)[static_cast<Eigen::Index>(axis)]);
    }
  }
  out.yaw = mean_of(yaw, options.block, level(options));
  for (std::size_t axis = 0; axis < 3; ++axis)
    out.offset[axis] = mean_of(offset[axis], options.block, level(options));
}

/// Bland and Altman 1986: between them lie 95 % of the differences, if they are normal.
std::pair<double, double> limits_of_agreement(const std::vector<double>& differences) {
  const auto n = static_cast<double>(differences.size());
  double mean = 0.0;
  for (const double value : differences) mean += value / n;
  double variance = 0.0;
  for (const double value : differences) variance += (value - mean) * (value - mean) / n;
  const double reach = 1.96 * std::sqrt(variance);
  return {mean - reach, mean + reach};
}

std::optional<JointDifference> compare_joint(const std::vector<Both>& frames, std::size_t j,
                                             const Comparison& whole,
                                             const CompareOptions& options) {
  std::array<Series, 3> axes;
  Series distance;
  double squares = 0.0;
  for (const Both& frame : frames) {
    if (!frame.a[j] || !frame.b[j]) continue;
    const Eigen::Vector3d d = *frame.a[j] - whole.a_from_b * *frame.b[j];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      axes[axis].times.push_back(frame.time);
      axes[axis].values.push_back(d[static_cast<Eigen::Index>(axis)]);
    }
    distance.times.push_back(frame.time);
    distance.values.push_back(d.norm());
    squares += d.squaredNorm();
  }
  if (distance.values.size() < kFewestFrames) return std::nullopt;
  JointDifference out;
  out.frames = distance.values.size();
  const auto n = static_cast<double>(out.frames);
  out.rms = std::sqrt(squares / n);
  out.drift = slope_of(distance, options.block, level(options));
  out.drift.mean *= kMinute;
  out.drift.half *= kMinute;
  std::tie(out.limit_low, out.limit_high) = limits_of_agreement(axes[1].values);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.offset[axis] = mean_of(axes[axis], options.block, level(options));
    out.differs = out.differs || out.offset[axis].differs(options.least);
  }
  const std::size_t rank = std::min(out.frames - 1, static_cast<std::size_t>(0.95 * n));
  std::ranges::nth_element(distance.values,
                           distance.values.begin() + static_cast<std::ptrdiff_t>(rank));
  out.p95 = distance.values[rank];
  return out;
}

PairComparison compare_pair(const std::vector<Both>& frames, const Comparison& whole,
                            const CompareOptions& options) {
  PairComparison pair;
  pair.frames = frames.size();
  pair.seconds = frames.empty() ? 0.0 : frames.back().time - frames.front().time;
  for (std::size_t j = 0; j < kJointCount; ++j)
    pair.joints[j] = compare_joint(frames, j, whole, options);
  return pair;
}

/// Median distance of the trunks after the transform; none: no frame in common.
std::optional<double> trunk_distance(const std::vector<Both>& frames,
                                     const Eigen::Isometry3d& a_from_b) {
  std::vector<double> all;
  for (const Both& frame : frames) {
    if (const auto d = apart({frame.time, frame.a, moved(frame.b, a_from_b)}))
      all.push_back(d->norm());
  }
  if (all.size() < kFewestFrames) return std::nullopt;
  return median(std::move(all));
}

void match_others(const People& a, const People& b, const CompareOptions& options,
                  Comparison& out) {
  std::vector<std::uint64_t> taken;
  for (const auto& [id, track] : a) {
    std::optional<std::uint64_t> best;
    std::vector<Both> best_frames;
    double least = kSamePerson;
    for (const auto& [other, theirs] : b) {
      if (std::ranges::find(taken, other) != taken.end()) continue;
      auto frames = together(track, theirs, out.lag, options.max_gap);
      const auto distance = trunk_distance(frames, out.a_from_b);
      if (!distance || *distance > least) continue;
      least = *distance;
      best = other;
      best_frames = std::move(frames);
    }
    if (!best) {
      out.only_a.push_back(id);
      continue;
    }
    taken.push_back(*best);
    out.pairs.push_back(compare_pair(best_frames, out, options));
    out.pairs.back().a = id;
    out.pairs.back().b = *best;
  }
  for (const auto& [id, track] : b)
    if (std::ranges::find(taken, id) == taken.end()) out.only_b.push_back(id);
}

void show_distances(const std::vector<Both>& frames, Comparison& out) {
  for (const Both& frame : frames) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!frame.a[j] || !frame.b[j]) continue;
      sum += (*frame.a[j] - out.a_from_b * *frame.b[j]).norm();
      count += 1.0;
    }
    if (count == 0.0) continue;
    out.times.push_back(frame.time);
    out.distances.push_back(sum / count);
  }
}

void say_worlds(Comparison& out) {
  if (out.yaw.differs(out.least_turn))
    out.differences.push_back(
        fmt::format("B is turned by {:.2f} deg about the vertical", to_deg(out.yaw.mean)));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (out.offset[axis].differs(out.least))
      out.differences.push_back(fmt::format("the trunk is {:.1f} mm off along {}",
                                            to_mm(out.offset[axis].mean), "xyz"[axis]));
  }
}

void say_differences(const CompareOptions& options, Comparison& out) {
  const bool counts = options.clock_range && out.lag_sigma;
  if (counts && std::abs(out.lag) > std::max(3.0 * *out.lag_sigma, kLeastLag))
    out.differences.push_back(fmt::format("B is {:.1f} ms {} A", 1e3 * std::abs(out.lag),
                                          out.lag > 0 ? "ahead of" : "behind"));
  if (!options.other_world) say_worlds(out);
  for (const PairComparison& pair : out.pairs) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!pair.joints[j] || !pair.joints[j]->differs) continue;
      const auto& offset = pair.joints[j]->offset;
      const double size = std::hypot(offset[0].mean, offset[1].mean, offset[2].mean);
      out.differences.push_back(
          fmt::format("{} of person {} is {:.1f} mm off once the worlds are one",
                      name_of(static_cast<JointId>(j)), pair.a, to_mm(size)));
    }
  }
}

}  // namespace

Result<Comparison> compare(const People& a, const People& b, const CompareOptions& options) {
  if (auto ok = checked(a, "A"); !ok) return pass(ok);
  if (auto ok = checked(b, "B"); !ok) return pass(ok);
  const Track& ours = longest(a).second;
  const Track& theirs = longest(b).second;
  Fit fit;
  if (auto ok = check_overlap(ours, theirs, options); !ok) return pass(ok);
  if (auto ok = find_lag(ours, theirs, options, fit); !ok) return pass(ok);
  const auto frames = together(ours, theirs, fit.lag, options.max_gap);
  if (frames.size() < kFewestFrames)
    return fail(ErrorCode::NotFound, "comparison",
                "the two have no time in common; if B's file states no UTC, leave --same-clock out "
                "and say --any-lag");
  if (!options.same_world) {
    if (auto ok = find_transform(frames, fit); !ok) return pass(ok);
  }
  Comparison out;
  out.lag = fit.lag;
  out.lag_sigma = fit.lag_sigma;
  out.a_from_b = fit.a_from_b;
  out.least = options.least;
  out.least_turn = options.least_turn;
  compare_worlds(frames, options, out);
  match_others(a, b, options, out);
  if (out.pairs.empty())
    return fail(ErrorCode::Conflict, "comparison",
                "nobody in B is where somebody in A is: do both show the same motion?");
  show_distances(frames, out);
  say_differences(options, out);
  return out;
}

}  // namespace chorus::comparison
