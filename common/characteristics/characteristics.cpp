#include "common/characteristics/characteristics.h"

#include <algorithm>
#include <cmath>

#include "common/base/duration.h"

namespace chorus::characteristics {
namespace {

constexpr const char* kNoMark =
    "one sensor alone does not see it: mark a spot on the floor 2 to 3 m before the sensor, "
    "measure its distance along the floor with a tape, have somebody turn once on it, and pass "
    "--distance";

/// A person who walks more than this need not face the sensor at first, as stances_of() assumes.
constexpr double kMostlyStanding = 0.7;  // share of the frames with the person

std::vector<JointId> limbs() {
  using enum JointId;
  return {ElbowLeft, ElbowRight, WristLeft, WristRight, KneeLeft, KneeRight, AnkleLeft, AnkleRight};
}

Noise with_factor(const JitterCell& tracked, const Jitter& jitter) {
  const JitterCell seen = jitter_over(jitter, limbs(), JointState::Tracked);
  const JitterCell guessed = jitter_over(jitter, limbs(), JointState::Inferred);
  const auto size = [](const JitterCell& cell) {
    return std::sqrt(cell.along * cell.along + 2 * cell.across * cell.across);
  };
  Noise noise{tracked.along, tracked.across, 1.0, guessed.frames};
  if (guessed.frames > 0 && size(seen) > 0) noise.inferred_factor = size(guessed) / size(seen);
  return noise;
}

}  // namespace

Result<Characteristics> characterise(const std::vector<SensorFrame>& frames, const Known& known) {
  const auto person = one_person(frames);
  if (!person) return pass(person);
  const std::vector<Stance> stances = stances_of(*person, known.turns);
  Characteristics found;
  found.sensor = person->sensor;
  found.seconds = chorus::seconds(person->frames.back() - person->frames.front());
  found.sights = person->sights.size();
  found.standing = static_cast<double>(std::ranges::count_if(person->sights, &Sight::standing)) /
                   static_cast<double>(found.sights);
  found.has_floor = person->has_floor;
  found.jitter = jitter_of(*person, stances);
  found.exchange = exchange_of(*person, stances);
  if (known.turns.empty() && found.standing < kMostlyStanding)
    found.exchange.front_rear = FrontRear::Unclear;
  found.coverage = coverage_of(*person);
  found.no_depth_bias = kNoMark;
  if (!known.mark) return found;
  const auto bias = depth_bias_by(*known.mark, *person, stances);
  if (!bias) return pass(bias);
  found.depth_bias = *bias;
  found.no_depth_bias.clear();
  return found;
}

Noise noise_of(const Jitter& jitter) {
  return with_factor(
      jitter_over(jitter, {JointId::Neck, JointId::SpineShoulder}, JointState::Tracked), jitter);
}

Noise limb_noise_of(const Jitter& jitter) {
  return with_factor(jitter_over(jitter, limbs(), JointState::Tracked), jitter);
}

}  // namespace chorus::characteristics
