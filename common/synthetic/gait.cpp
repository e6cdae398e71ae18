#include "common/synthetic/gait.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/geometry/rotation.h"
#include "common/motion/cmu_walk.h"
#include "common/motion/motion.h"
#include "common/synthetic/smoothstep.h"

namespace chorus::synthetic {
namespace {

using motion::AmcFrame;

// Channels 0-2 are tx ty tz, 3-5 the angles of the root.
constexpr std::size_t kRootTranslation = 3;
constexpr std::size_t kMinCycle = 100;  // [frames] at 120 Hz: 0.83 s
constexpr std::size_t kMaxCycle = 150;  // [frames]: 1.25 s
constexpr std::size_t kBlend = 24;      // [frames] cross-faded at the seam: 0.2 s

/// How much two poses differ: the sum of the squared differences of their angles.
double mismatch(const AmcFrame& a, const AmcFrame& b) {
  double sum = 0;
  for (std::size_t c = kRootTranslation; c < a.size(); ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

struct Cut {
  std::size_t start = 0;
  std::size_t length = 0;
};

/// The cycle for which the frames up to its end are most similar to the frames up to its start.
Cut best_cut(const std::vector<AmcFrame>& take) {
  Cut best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t length = kMinCycle; length <= kMaxCycle; ++length) {
    for (std::size_t start = kBlend; start + length < take.size(); ++start) {
      double sum = 0;
      for (std::size_t back = 0; back <= kBlend; back += kBlend / 4) {
        sum += mismatch(take[start - back], take[start + length - back]);
      }
      if (sum < least) {
        least = sum;
        best = {start, length};
      }
    }
  }
  return best;
}

/// Turns the legs of a mean walking pose into standing ones: the knees become as straight as they
/// get in the walk; the thighs turn back and the feet down by half of that, so that the feet stay
/// flat under the hips.
void straighten_legs(const motion::AsfSkeleton& skeleton, const std::vector<AmcFrame>& cycle,
                     AmcFrame& standing) {
  for (const auto& [thigh, shank, foot] :
       {std::array{"lfemur", "ltibia", "lfoot"}, std::array{"rfemur", "rtibia", "rfoot"}}) {
    const auto channel = [&](const char* bone) {
      // rx is the bone's first channel.
      return skeleton.bones[bone_named(skeleton, bone)].first_channel;
    };
    const std::size_t knee = channel(shank);
    double straightest = standing[knee];
    for (const AmcFrame& frame : cycle) straightest = std::min(straightest, frame[knee]);
    const double change = standing[knee] - straightest;
    standing[knee] = straightest;
    standing[channel(thigh)] += 0.5 * change;
    standing[channel(foot)] += 0.5 * change;
  }
}

double lowest_foot(const Skeleton<WorldSpace>& body) {
  return std::min(body[JointId::FootLeft].position.y(), body[JointId::FootRight].position.y());
}

AmcFrame mixed(const AmcFrame& a, const AmcFrame& b, double s) {
  AmcFrame out(a.size());
  for (std::size_t c = 0; c < a.size(); ++c) out[c] = a[c] + s * (b[c] - a[c]);
  return out;
}

}  // namespace

Gait::Gait(const motion::AsfSkeleton& skeleton, const std::vector<AmcFrame>& take)
    : skeleton_(&skeleton) {
  const Cut cut = best_cut(take);
  close_loop(take, cut.start, cut.length);
  stand_on_floor();
}

void Gait::close_loop(const std::vector<AmcFrame>& take, std::size_t start, std::size_t length) {
  const AmcFrame& first = take[start];
  const AmcFrame& last = take[start + length];
  const Eigen::Vector3d way = Eigen::Vector3d(last.data()) - Eigen::Vector3d(first.data());
  period_ = static_cast<double>(length) / motion::kCmuRateHz;
  stride_ = std::hypot(way.x(), way.z());
  heading_ = std::atan2(way.x(), way.z());
  // The frame relative to a point that moves with the mean velocity; this also removes the slope of
  // the recorded floor.
  const auto relative = [&](std::size_t index) {
    AmcFrame frame = take[index];
    const double share =
        (static_cast<double>(index) - static_cast<double>(start)) / static_cast<double>(length);
    for (std::size_t c = 0; c < kRootTranslation; ++c) {
      frame[c] -= share * way[static_cast<Eigen::Index>(c)];
    }
    return frame;
  };
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t left = length - i;
    const double fade = left > kBlend ? 0.0 : smoothstep(1.0 - static_cast<double>(left) / kBlend);
    cycle_.push_back(fade > 0 ? mixed(relative(start + i), relative(start + i - length), fade)
                              : relative(start + i));
  }
}

void Gait::stand_on_floor() {
  standing_.assign(cycle_.front().size(), 0.0);
  for (const AmcFrame& frame : cycle_) {
    for (std::size_t c = 0; c < frame.size(); ++c) {
      standing_[c] += frame[c] / static_cast<double>(cycle_.size());
    }
  }
  straighten_legs(*skeleton_, cycle_, standing_);
  for (AmcFrame& frame : cycle_) {
    frame[0] -= standing_[0];
    frame[2] -= standing_[2];
  }
  standing_[0] = standing_[2] = 0.0;
  double lowest = std::numeric_limits<double>::infinity();
  for (const AmcFrame& frame : cycle_) {
    lowest = std::min(lowest, lowest_foot(motion::kinect_skeleton(*skeleton_, frame)));
  }
  for (AmcFrame& frame : cycle_) frame[1] += kToeHeight - lowest;
  standing_[1] += kToeHeight - lowest_foot(motion::kinect_skeleton(*skeleton_, standing_));
}

AmcFrame Gait::channels(double phase, double amplitude) const {
  const double place = (phase - std::floor(phase)) * static_cast<double>(cycle_.size());
  const std::size_t before = std::min(static_cast<std::size_t>(place), cycle_.size() - 1);
  const std::size_t after = (before + 1) % cycle_.size();
  const AmcFrame walking =
      mixed(cycle_[before], cycle_[after], place - static_cast<double>(before));
  return mixed(standing_, walking, amplitude);
}

Skeleton<WorldSpace> Gait::pose(double phase, double amplitude) const {
  if (!std::isfinite(phase) || !std::isfinite(amplitude)) return pose(0.0, 0.0);
  Skeleton<WorldSpace> body = motion::kinect_skeleton(*skeleton_, channels(phase, amplitude));
  const Eigen::Quaterniond straight = about_y(-heading_);
  for (Joint& joint : body.joints) {
    joint.position = straight * joint.position;
    if (is_unit(joint.orientation)) joint.orientation = straight * joint.orientation;
  }
  return body;
}

const Gait& Gait::built_in(std::size_t take) {
  static const std::vector<Gait> gaits = [] {
    std::vector<Gait> cut;
    const motion::CmuWalk& walk = motion::cmu_walk();
    for (const auto& each : walk.takes) cut.emplace_back(walk.skeleton, each);
    return cut;
  }();
  return gaits[take % gaits.size()];
}

}  // namespace chorus::synthetic
