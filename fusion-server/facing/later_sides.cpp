#include "fusion-server/facing/later_sides.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::facing {
namespace {

using Weights = SidesStep::Weights;

constexpr std::size_t kWrong = 1;
constexpr std::size_t kBackwards = 2;

void scale(Weights& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
}

/// What is expected of the next instant, given each state of this one, if a cleared bit is set with
/// the chance `set` and a set bit cleared with the chance `cleared`.
void expect(Weights& next, std::size_t bit, double set, double cleared) {
  for (std::size_t state = 0; state < next.size(); ++state) {
    if ((state & bit) != 0) continue;
    const double if_clear = next[state];
    const double if_set = next[state | bit];
    next[state] = (1.0 - set) * if_clear + set * if_set;
    next[state | bit] = (1.0 - cleared) * if_set + cleared * if_clear;
  }
}

/// What an instant and all after it say about the states before it; `after`: what those after it
/// say about its own.
Weights before(const SidesStep& step, Weights after) {
  if (step.first) return {1.0, 1.0, 1.0, 1.0};
  if (step.turned_round) {
    std::swap(after[0], after[kWrong]);
    std::swap(after[kBackwards], after[kBackwards | kWrong]);
  }
  for (std::size_t state = 0; state < after.size(); ++state) after[state] *= step.likelihood[state];
  expect(after, kBackwards, step.begins, step.ends);
  expect(after, kWrong, step.slipped, step.slipped);
  scale(after);
  return after;
}

double right(const Weights& forward, const Weights& after) {
  const double held = forward[0] * after[0] + forward[kBackwards] * after[kBackwards];
  const double opposite =
      forward[kWrong] * after[kWrong] + forward[kBackwards | kWrong] * after[kBackwards | kWrong];
  return held / (held + opposite);
}

}  // namespace

std::vector<double> right_afterwards(std::span<const SidesStep> steps) {
  std::vector<double> found(steps.size());
  Weights after{1.0, 1.0, 1.0, 1.0};
  for (std::size_t i = steps.size(); i-- > 0;) {
    found[i] = right(steps[i].weights, after);
    after = before(steps[i], after);
  }
  return found;
}

bool exchanged_afterwards(const SidesStep& step, double right, std::optional<bool> before,
                          double change_odds) {
  const double against = std::log((1.0 - right) / right);
  const bool is_published = !step.first && before && *before != step.turned_round;
  return against > (is_published ? 0.0 : change_odds);
}

void exchange_sides(Person& person) {
  for (SensorView& view : person.views) {
    for (const auto& [left, right] : kMirrorPairs)
      std::swap(view.skeleton[left], view.skeleton[right]);
    for (Joint& joint : view.skeleton.joints) joint.orientation.coeffs().setZero();
    view.facing = wrap_angle(view.facing + std::numbers::pi);
  }
}

}  // namespace chorus::facing
