#include "fusion-server/registration/offset_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry/plane.h"
#include "fusion-server/registration/offset_interval.h"
#include "fusion-server/registration/pairs.h"

namespace chorus::registration {
namespace {

using enum JointId;

// Number of frames that are averaged, so that interpolation removes as much noise at one offset as
// at another.
constexpr std::size_t kSmoothed = 5;
// Most frames of the source that are used; in a longer walk, neighbouring frames share noise.
constexpr std::size_t kMostFrames = 300;
constexpr std::size_t kMinFrames = 30;  // fewest frames that an offset must leave
constexpr double kCoarse = 0.020;       // [s]
constexpr double kFine = 0.002;         // [s]
constexpr double kOptimism = 1.3;  // errors on simulated walks / errors according to the likelihood
constexpr double kErrorTime = 2.0;  // [s] after which a sensor's error is nearly independent

struct Sides {
  JointId left;
  JointId right;
};
constexpr std::array kAxis{Neck, SpineShoulder, Head, SpineMid, SpineBase};
constexpr std::array kMirrored{Sides{ShoulderLeft, ShoulderRight}, Sides{HipLeft, HipRight}};

std::size_t slot(JointId id) { return static_cast<std::size_t>(id); }

/// Mean of frames [first, first + kSmoothed), at their mean time.
TrailFrame mean_of(const std::vector<TrailFrame>& frames, std::size_t first) {
  TrailFrame mean = frames[first];
  Duration later{0};
  mean.points.fill(Eigen::Vector3d::Zero());
  for (std::size_t i = first; i < first + kSmoothed; ++i) {
    mean.seen &= frames[i].seen;
    later += frames[i].captured - frames[first].captured;
    for (std::size_t k = 0; k < kJointCount; ++k) {
      if (mean.has(k)) mean.points[k] += frames[i].points[k];
    }
  }
  mean.captured += later / static_cast<int>(kSmoothed);
  for (Eigen::Vector3d& point : mean.points) point /= static_cast<double>(kSmoothed);
  return mean;
}

Trail smoothed(const Trail& trail, Duration max_gap) {
  Trail out{trail.sensor, {}};
  std::size_t whole = 1;  // number of frames up to this one without a gap
  for (std::size_t i = 0; i < trail.frames.size(); ++i) {
    const bool follows = i > 0 && trail.frames[i].body == trail.frames[i - 1].body &&
                         trail.frames[i].captured - trail.frames[i - 1].captured <= max_gap;
    whole = follows ? whole + 1 : 1;
    if (whole < kSmoothed) continue;
    TrailFrame mean = mean_of(trail.frames, i + 1 - kSmoothed);
    if (mean.seen != 0) out.frames.push_back(std::move(mean));
  }
  return out;
}

/// The frames that some offset up to `range` puts beside one of the other trail: two sensors that
/// share a passage only have few of these among all that each of them saw.
Trail shared_part(const Trail& trail, const Trail& other, Duration range) {
  Trail out{trail.sensor, {}};
  auto near = other.frames.begin();
  for (const TrailFrame& frame : trail.frames) {
    while (near != other.frames.end() && near->captured < frame.captured - range) ++near;
    if (near == other.frames.end()) break;
    if (near->captured <= frame.captured + range) out.frames.push_back(frame);
  }
  return out;
}

Trail thinned(const Trail& trail) {
  const std::size_t count = trail.frames.size();
  const std::size_t step = std::max<std::size_t>(1, (count + kMostFrames - 1) / kMostFrames);
  Trail out{trail.sensor, {}};
  for (std::size_t i = 0; i < count; i += step) out.frames.push_back(trail.frames[i]);
  return out;
}

/// The frames that stay within the time span of the other trail at every offset up to `range`; all
/// of them if fewer than half do.
Trail inner_part(const Trail& trail, const Trail& other, Duration range) {
  if (other.frames.empty()) return trail;
  Trail out{trail.sensor, {}};
  const Timestamp first = other.frames.front().captured + range;
  const Timestamp last = other.frames.back().captured - range;
  for (const TrailFrame& frame : trail.frames) {
    if (frame.captured >= first && frame.captured <= last) out.frames.push_back(frame);
  }
  return out.frames.size() < trail.frames.size() / 2 ? trail : out;
}

/// Adds the points that do not depend on which side is called left, where both sensors have them.
void add_points(const TrailFrame& target, const TrailFrame& source, std::size_t frame,
                Points& points) {
  const auto both = [&](JointId id) { return target.has(slot(id)) && source.has(slot(id)); };
  const auto add = [&](JointId a, JointId b) {
    if (!both(a) || !both(b)) return;
    points.target.push_back(0.5 * (target.points[slot(a)] + target.points[slot(b)]));
    points.source.push_back(0.5 * (source.points[slot(a)] + source.points[slot(b)]));
    points.frame.push_back(frame);
  };
  for (const JointId id : kAxis) add(id, id);
  for (const Sides& sides : kMirrored) add(sides.left, sides.right);
}

/// The middle of the points of each frame: for levelled sensors, the person's path is enough.
Points middles_of(const Points& all) {
  Points middles;
  for (std::size_t i = 0; i < all.frame.size();) {
    const std::size_t frame = all.frame[i];
    Eigen::Vector3d target = Eigen::Vector3d::Zero();
    Eigen::Vector3d source = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (; i < all.frame.size() && all.frame[i] == frame; ++i, ++count) {
      target += all.target[i];
      source += all.source[i];
    }
    middles.target.push_back(target / count);
    middles.source.push_back(source / count);
    middles.frame.push_back(frame);
  }
  return middles;
}

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : points) sum += x;
  return sum / static_cast<double>(points.size());
}

/// Subtracts from each point what its predecessor predicts.  A sensor's error changes slowly, so
/// the new part of a step or a turn contains most of the information about time.
Points whitened(const Points& points, const Trail& source) {
  const Eigen::Vector3d target_mean = mean_of(points.target);
  const Eigen::Vector3d source_mean = mean_of(points.source);
  Points white;
  for (std::size_t i = 1; i < points.frame.size(); ++i) {
    const Duration apart =
        source.frames[points.frame[i]].captured - source.frames[points.frame[i - 1]].captured;
    const double kept = std::exp(-seconds(apart) / kErrorTime);
    const auto news = [&](const std::vector<Eigen::Vector3d>& x, const Eigen::Vector3d& mean) {
      return Eigen::Vector3d(x[i] - mean - kept * (x[i - 1] - mean));
    };
    white.target.push_back(news(points.target, target_mean));
    white.source.push_back(news(points.source, source_mean));
    white.frame.push_back(points.frame[i]);
  }
  return white;
}

}  // namespace

Walker offset_walker(const WalkTrack& walk, const RegistrationConfig& config) {
  RegistrationConfig all = config;
  all.joints = JointChoice::All;
  Walker walker = walker_of(walk, all);
  walker.trail = smoothed(walker.trail, config.max_gap);
  return walker;
}

OffsetProfile::OffsetProfile(const Walker& target, const Walker& source,
                             const RegistrationConfig& config, double range)
    : range_(range),
      max_gap_(config.max_gap),
      target_(target.trail),
      source_(thinned(shared_part(source.trail, target.trail, from_seconds(range)))),
      inner_(inner_part(source_, target_, from_seconds(range))),
      levelled_(config.use_floor && target.floor.floor && source.floor.floor) {
  if (!levelled_) return;
  level_from_target_ = level(*target.floor.floor);
  level_from_source_ = level(*source.floor.floor);
}

Points OffsetProfile::points_at(const Trail& source, double offset) const {
  TrailReader reader(target_, max_gap_);
  Points points;
  for (std::size_t i = 0; i < source.frames.size(); ++i) {
    const TrailFrame& seen = source.frames[i];
    const auto other = reader.at(seen.captured + from_seconds(offset));
    if (other) add_points(other->frame, seen, i, points);
  }
  for (Eigen::Vector3d& x : points.target) x = level_from_target_ * x;
  for (Eigen::Vector3d& x : points.source) x = level_from_source_ * x;
  return points;
}

std::optional<OffsetFit> OffsetProfile::fit(const Trail& source, double offset) const {
  Points points = points_at(source, offset);
  if (levelled_) points = middles_of(points);
  if (points.frame.size() < kMinFrames) return std::nullopt;
  auto walk = fit_place(levelled_ ? whitened(points, source) : points, levelled_);
  if (!walk) return std::nullopt;
  return OffsetFit{offset, std::move(*walk)};
}

std::optional<Eigen::Vector3d> OffsetProfile::place_at(double offset) const {
  const Points points = points_at(source_, offset);
  if (points.frame.size() < kMinFrames) return std::nullopt;
  const auto walk = fit_place(points, levelled_);
  if (!walk) return std::nullopt;
  return walk->target_from_source * level_from_source_.translation();
}

std::vector<OffsetFit> OffsetProfile::sweep(const Trail& source, double middle, double reach,
                                            double step) const {
  std::vector<OffsetFit> fits;
  const int steps = static_cast<int>(std::ceil(reach / step));
  for (int i = -steps; i <= steps; ++i) {
    if (auto found = fit(source, middle + i * step)) fits.push_back(std::move(*found));
  }
  return fits;
}

std::optional<PairOffset> OffsetProfile::best() const {
  double middle = 0.0;
  std::optional<OffsetInterval> wide;
  if (range_ > kCoarse) {
    const auto coarse = sweep(inner_, 0.0, range_, kCoarse);
    if (coarse.empty()) return std::nullopt;
    wide = interval_of(coarse);
    middle = wide->middle;
  }
  const auto fine = sweep(source_, middle, std::min(range_, kCoarse), kFine);
  if (fine.empty()) return std::nullopt;
  OffsetInterval told = interval_of(fine);
  if (wide && wide->high - wide->low > 2.0 * kCoarse) {
    told.low = std::min(told.low, wide->low);
    told.high = std::max(told.high, wide->high);
  }
  const bool open = told.low <= -range_ || told.high >= range_;
  const double half = std::max(0.5 * kFine, 0.5 * (told.high - told.low));
  return PairOffset{told.middle, open ? range_ : kOptimism * half / kSigmas95};
}

}  // namespace chorus::registration
