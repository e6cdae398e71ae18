#include "common/exporters/take.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "common/base/median.h"
#include "common/body/interpolate.h"
#include "common/motion/motion.h"

namespace chorus::exporters {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;
constexpr Duration kSameInstant = std::chrono::microseconds(1);
constexpr double kWholeHertz = 1e-6;  // Relative tolerance for rounding a rate to whole hertz.
constexpr double kUsualHz = 30.0;     // For a single sample.
constexpr double kMaxRateHz = 1000.0;

using Samples = std::vector<FusedSample>;

Result<void> keep_person(Samples& samples, const TakeOptions& options) {
  if (!options.person) return {};
  std::map<PersonId, std::size_t> there;
  for (const FusedSample& sample : samples) ++there[sample.person];
  std::erase_if(samples, [&](const FusedSample& s) { return s.person != *options.person; });
  if (!samples.empty()) return {};
  std::string known;
  for (const auto& [person, count] : there) known += " " + std::to_string(person.value);
  return fail(ErrorCode::NotFound, "person " + std::to_string(options.person->value),
              "is not in these frames; there are:" + (known.empty() ? " none" : known));
}

double usual_rate(const Samples& sorted) {
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const Duration step = sorted[i].instant - sorted[i - 1].instant;
    if (step > kSameInstant) steps.push_back(step);
  }
  if (steps.empty()) return kUsualHz;
  const Duration usual = median(std::move(steps));
  // The usual step, adjusted so that a whole number of steps leads to the last sample.
  const auto span = static_cast<double>((sorted.back().instant - sorted.front().instant).count());
  const double count = std::round(span / static_cast<double>(usual.count()));
  const double rate = count * kNanosecondsPerSecond / span;
  const double whole = std::round(rate);
  return whole > 0 && std::abs(rate - whole) < kWholeHertz * whole ? whole : rate;
}

Pose pose_of(const FusedSample& sample) { return {sample.skeleton, sample.variance}; }

Pose pose_between(const FusedSample& a, const FusedSample& b, double s) {
  Pose pose{interpolate(a.skeleton, b.skeleton, s), {}};
  for (std::size_t j = 0; j < kJointCount; ++j)
    pose.variance[j] = (1 - s) * a.variance[j] + s * b.variance[j];
  return pose;
}

/// The pose of one person at an instant; `after` is the first sample that is not earlier than
/// `instant` by more than kSameInstant.
Pose pose_at(const Samples& samples, std::size_t after, Timestamp instant, Duration max_gap) {
  if (after == samples.size()) return {};
  const FusedSample& next = samples[after];
  if (next.instant <= instant + kSameInstant) return pose_of(next);
  if (after == 0) return {};
  const FusedSample& last = samples[after - 1];
  if (next.instant - last.instant > max_gap) return {};
  const double s = static_cast<double>((instant - last.instant).count()) /
                   static_cast<double>((next.instant - last.instant).count());
  return pose_between(last, next, s);
}

/// The grid instants, or those of the samples that are kept unchanged there: an instant of 1/30 s
/// is rounded to whole nanoseconds, and whoever compares texts needs the frame's own.
std::vector<Timestamp> instants_of(const Samples& sorted, const Take& take) {
  std::vector<Timestamp> instants;
  instants.reserve(take.frames);
  std::size_t next = 0;
  for (std::size_t frame = 0; frame < take.frames; ++frame) {
    const Timestamp instant = instant_of(take, frame);
    while (next < sorted.size() && sorted[next].instant < instant - kSameInstant) ++next;
    const bool same = next < sorted.size() && sorted[next].instant <= instant + kSameInstant;
    instants.push_back(same ? sorted[next].instant : instant);
  }
  return instants;
}

Result<PersonTrack> track_of(const Samples& samples, const Take& take, Duration max_gap) {
  PersonTrack track{samples.front().person, {}};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].instant == samples[i - 1].instant)
      return fail(ErrorCode::Malformed, "person " + std::to_string(track.person.value),
                  "is there twice at " + to_iso8601(samples[i].instant));
  }
  track.poses.reserve(take.frames);
  std::size_t after = 0;
  for (std::size_t frame = 0; frame < take.frames; ++frame) {
    const Timestamp instant = instant_of(take, frame);
    while (after < samples.size() && samples[after].instant < instant - kSameInstant) ++after;
    track.poses.push_back(pose_at(samples, after, instant, max_gap));
  }
  return track;
}

}  // namespace

Timestamp instant_of(const Take& take, std::size_t frame) {
  if (frame < take.instants.size()) return take.instants[frame];
  const double ns = static_cast<double>(frame) * kNanosecondsPerSecond / take.rate_hz;
  return take.start + Duration(std::llround(ns));
}

Result<Take> make_take(std::vector<FusedSample> samples, const TakeOptions& options) {
  if (const auto kept = keep_person(samples, options); !kept) return pass(kept);
  if (samples.empty())
    return fail(ErrorCode::NotFound, "fused frames", "there is nobody in any of them.");
  if (!(options.rate_hz >= 0) || options.rate_hz > kMaxRateHz)
    return fail(ErrorCode::InvalidArgument, "rate", "must be at most 1000 Hz and above zero.");
  std::stable_sort(samples.begin(), samples.end(),
                   [](const auto& a, const auto& b) { return a.instant < b.instant; });
  std::map<PersonId, Samples> persons;
  for (const FusedSample& sample : samples) persons[sample.person].push_back(sample);
  Take take;
  take.start = samples.front().instant;
  take.rate_hz = options.rate_hz > 0 ? options.rate_hz : usual_rate(samples);
  const Duration span = samples.back().instant - take.start + kSameInstant;
  const double frames =
      std::floor(static_cast<double>(span.count()) / kNanosecondsPerSecond * take.rate_hz) + 1;
  if (frames * static_cast<double>(persons.size()) > static_cast<double>(kMaxPoses))
    return fail(ErrorCode::TooLarge, "fused frames",
                "make more than 500000 poses; export one person, fewer hertz, or a part.");
  take.frames = static_cast<std::size_t>(frames);
  take.instants = instants_of(samples, take);
  samples = {};
  for (const auto& [person, own] : persons) {
    auto track = track_of(own, take, options.max_gap);
    if (!track) return pass(track);
    take.persons.push_back(std::move(*track));
  }
  return take;
}

std::string prefix_of(const Take& take, const PersonTrack& track, std::string_view separator) {
  if (take.persons.size() < 2) return "";
  return "P" + std::to_string(track.person.value) + std::string(separator);
}

}  // namespace chorus::exporters
