#include "tests/judge/log_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kThirdDifferenceGain =
    20.0;  // variance of a third difference of white noise over that of the noise: 1 + 9 + 9 + 1
constexpr double kMadToSigma = 1.4826;
constexpr double kUsualPace = 1.5;  // wider than this many median steps is a gap

struct Sample {
  double time;
  const Skeleton<SensorSpace>* body;
};

std::vector<Sample> samples_of(const std::vector<SensorFrame>& frames) {
  std::vector<Sample> samples;
  for (const SensorFrame& frame : frames) {
    if (frame.bodies.empty()) continue;
    samples.push_back({seconds(frame.captured.time_since_epoch()), &frame.bodies.front().skeleton});
  }
  return samples;
}

/// Runs of samples without a gap.
std::vector<std::vector<Sample>> runs_of(const std::vector<Sample>& samples) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i)
    steps.push_back(samples[i].time - samples[i - 1].time);
  const double usual = median(steps);
  std::vector<std::vector<Sample>> runs(1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0 && samples[i].time - samples[i - 1].time > kUsualPace * usual) runs.emplace_back();
    runs.back().push_back(samples[i]);
  }
  return runs;
}

/// A joint, and the state that it must have in all four frames.
struct Wanted {
  std::size_t joint;
  JointState state;
};

double white_noise(const std::vector<std::vector<Sample>>& runs, const Wanted& wanted, int axis) {
  std::vector<double> sizes;
  for (const auto& run : runs) {
    for (std::size_t i = 3; i < run.size(); ++i) {
      const auto at = [&](std::size_t back) {
        return run[i - back].body->joints[wanted.joint].position[axis];
      };
      const auto is_wanted = [&](std::size_t back) {
        return run[i - back].body->joints[wanted.joint].state == wanted.state;
      };
      if (!is_wanted(0) || !is_wanted(1) || !is_wanted(2) || !is_wanted(3)) continue;
      sizes.push_back(std::abs(at(0) - 3 * at(1) + 3 * at(2) - at(3)));
    }
  }
  return sizes.empty() ? kNone : kMadToSigma * median(sizes) / std::sqrt(kThirdDifferenceGain);
}

std::vector<double> lengths(const std::vector<Sample>& run, const Bone& bone) {
  std::vector<double> values;
  for (const Sample& sample : run) {
    const Joint& a = (*sample.body)[bone.parent];
    const Joint& b = (*sample.body)[bone.child];
    if (a.seen() && b.seen()) values.push_back((a.position - b.position).norm());
  }
  return values;
}

std::array<double, 3> steps_of(const std::vector<Sample>& samples) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i)
    steps.push_back(samples[i].time - samples[i - 1].time);
  return {median(steps), percentile(steps, 0.95), worst(steps)};
}

std::size_t unoriented(const std::vector<Sample>& samples) {
  std::size_t count = 0;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    count += std::ranges::all_of(samples, [joint](const Sample& sample) {
      return sample.body->joints[joint].orientation.coeffs().isZero(0.0);
    });
  }
  return count;
}

}  // namespace

double deviation(const std::vector<double>& values) {
  if (values.size() < 2) return kNone;
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double autocorrelation(const std::vector<double>& values, std::size_t lag) {
  if (values.size() < lag + 10) return kNone;
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += (values[i] - mean) * (values[i] - mean);
    if (i + lag < values.size()) products += (values[i] - mean) * (values[i + lag] - mean);
  }
  return squares > 0 ? products / squares : kNone;
}

LogStatistics statistics_of(const std::vector<SensorFrame>& frames) {
  const std::vector<Sample> samples = samples_of(frames);
  LogStatistics result;
  result.frames = samples.size();
  if (samples.size() < 10) return result;
  const auto runs = runs_of(samples);
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    std::size_t seen = 0;
    std::size_t inferred = 0;
    for (const Sample& sample : samples) {
      seen += sample.body->joints[joint].seen();
      inferred += sample.body->joints[joint].state == JointState::Inferred;
    }
    result.inferred_share[joint] =
        seen == 0 ? kNone : static_cast<double>(inferred) / static_cast<double>(seen);
    for (int axis = 0; axis < 3; ++axis) {
      result.white[joint][axis] = white_noise(runs, {joint, JointState::Tracked}, axis);
      result.white_inferred[joint][axis] = white_noise(runs, {joint, JointState::Inferred}, axis);
    }
  }
  result.steps = steps_of(samples);
  result.unoriented = unoriented(samples);
  constexpr std::size_t kThirdOfASecond = 10;  // frames
  constexpr std::size_t kLater = 12;
  for (const Bone& bone : kBones) {
    const std::vector<double> values = lengths(samples, bone);
    result.bone_std[bone.child] = deviation(values);
    result.lag_frame[bone.child] = autocorrelation(values, 1);
    result.lag_third[bone.child] = autocorrelation(values, kThirdOfASecond);
    result.lag_later[bone.child] = autocorrelation(values, kLater);
  }
  return result;
}

}  // namespace chorus::bench
