#include "common/characteristics/jitter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "common/base/units.h"
#include "common/body/bones.h"

namespace chorus::characteristics {
namespace {

constexpr double kHalfWindow = 0.25;    // [s]
constexpr std::size_t kLeastHalf = 3;   // frames: a parabola needs more than three points
constexpr double kDistanceRange = 0.5;  // [m]
constexpr std::size_t kLeastFrames = 15;
constexpr double kFrontal = deg(35);  // Otto Fig. 7
// Standard deviation of second differences of noise, over that of first differences.
constexpr double kBendOverStep = std::numbers::sqrt3;

/// Weights of a parabola fitted to 2 h + 1 equidistant values, at the middle one.
std::vector<double> parabola(std::size_t half) {
  const double m = static_cast<double>(2 * half + 1);
  std::vector<double> weights;
  for (std::size_t j = 0; j <= 2 * half; ++j) {
    const double k = static_cast<double>(j) - static_cast<double>(half);
    weights.push_back(3 * (3 * m * m - 7 - 20 * k * k) / (4 * m * (m * m - 4)));
  }
  return weights;
}

/// For each sight, the length of the run that ends with it: sights in which the person stands,
/// without a gap or a change of labels.
std::vector<std::size_t> runs_of(const OnePerson& person, const std::vector<Stance>& stances) {
  std::vector<std::size_t> runs(person.sights.size(), 0);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!person.sights[i].standing) continue;
    runs[i] = 1;
    if (i == 0 || runs[i - 1] == 0) continue;
    const double step = seconds(person.sights[i].at - person.sights[i - 1].at);
    const bool same = stances[i].exchanged == stances[i - 1].exchanged;
    if (step <= kUsualStep * person.step && same) runs[i] = runs[i - 1] + 1;
  }
  return runs;
}

struct Sums {
  std::size_t frames = 0;
  double along = 0.0;
  double across = 0.0;
};

using Key = std::tuple<JointId, JointState, long>;

class Window {
 public:
  Window(const OnePerson& person, std::size_t half)
      : person_(person), half_(half), weights_(parabola(half)) {}

  /// Deviation of the joint at sight `middle` from the trend; none if its state changes within.
  [[nodiscard]] std::optional<Eigen::Vector3d> deviation(std::size_t middle, JointId id) const {
    const Joint& here = person_.sights[middle].body[id];
    Eigen::Vector3d trend = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < weights_.size(); ++j) {
      const Joint& joint = person_.sights[middle + j - half_].body[id];
      if (!joint.seen() || joint.state != here.state) return std::nullopt;
      trend += weights_[j] * joint.position;
    }
    return ((here.position - trend) / std::sqrt(1.0 - weights_[half_])).eval();
  }

 private:
  const OnePerson& person_;
  std::size_t half_;
  std::vector<double> weights_;
};

void add(std::map<Key, Sums>& all, const Window& window, const Sight& sight, std::size_t middle) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto id = static_cast<JointId>(j);
    const auto off = window.deviation(middle, id);
    if (!off) continue;
    const Joint& joint = sight.body[id];
    const double distance = joint.position.norm();
    if (distance <= 0.0) continue;
    const double along = off->dot(joint.position / distance);
    Sums& sums = all[{id, joint.state, std::lround(std::floor(distance / kDistanceRange))}];
    ++sums.frames;
    sums.along += along * along;
    sums.across += (off->squaredNorm() - along * along) / 2;
  }
}

Side side_of(double angle) {
  const double away = away_from_sensor(angle);
  if (away <= kFrontal) return Side::Front;
  return away >= std::numbers::pi - kFrontal ? Side::Rear : Side::Side;
}

std::vector<StepCell> steps_of(const OnePerson& person, const std::vector<Stance>& stances,
                               const std::vector<std::size_t>& runs) {
  std::map<std::pair<JointId, Side>, StepCell> all;
  for (std::size_t i = 2; i < runs.size(); ++i) {
    if (runs[i] < 3 || !stances[i - 1].angle) continue;
    for (const JointId id : kCoreJoints) {
      const auto at = [&](std::size_t back) -> const Joint& {
        return person.sights[i - back].body[id];
      };
      if (!at(0).seen() || !at(1).seen() || !at(2).seen()) continue;
      const Side side = side_of(*stances[i - 1].angle);
      StepCell& cell = all[{id, side}];
      cell.joint = id;
      cell.side = side;
      ++cell.frames;
      cell.step += (at(0).position - 2 * at(1).position + at(2).position).norm() / kBendOverStep;
    }
  }
  std::vector<StepCell> steps;
  for (auto& [key, cell] : all) {
    if (cell.frames < kLeastFrames) continue;
    cell.step /= static_cast<double>(cell.frames);
    steps.push_back(cell);
  }
  return steps;
}

}  // namespace

Jitter jitter_of(const OnePerson& person, const std::vector<Stance>& stances) {
  const auto half = std::max(kLeastHalf, static_cast<std::size_t>(kHalfWindow / person.step + 0.5));
  const std::vector<std::size_t> runs = runs_of(person, stances);
  const Window window(person, half);
  std::map<Key, Sums> all;
  for (std::size_t last = 2 * half; last < runs.size(); ++last) {
    if (runs[last] <= 2 * half) continue;
    add(all, window, person.sights[last - half], last - half);
  }
  Jitter jitter;
  for (const auto& [key, sums] : all) {
    if (sums.frames < kLeastFrames) continue;
    const auto& [joint, state, range] = key;
    const double count = static_cast<double>(sums.frames);
    jitter.cells.push_back({joint, state, (static_cast<double>(range) + 0.5) * kDistanceRange,
                            sums.frames, std::sqrt(sums.along / count),
                            std::sqrt(sums.across / count)});
  }
  jitter.steps = steps_of(person, stances, runs);
  return jitter;
}

JitterCell jitter_over(const Jitter& jitter, const std::vector<JointId>& joints, JointState state) {
  JitterCell whole;
  whole.state = state;
  double along = 0.0;
  double across = 0.0;
  double distance = 0.0;
  for (const JitterCell& cell : jitter.cells) {
    if (cell.state != state || std::ranges::find(joints, cell.joint) == joints.end()) continue;
    const double count = static_cast<double>(cell.frames);
    whole.frames += cell.frames;
    along += count * cell.along * cell.along;
    across += count * cell.across * cell.across;
    distance += count * cell.distance;
  }
  if (whole.frames == 0) return whole;
  const double count = static_cast<double>(whole.frames);
  whole.along = std::sqrt(along / count);
  whole.across = std::sqrt(across / count);
  whole.distance = distance / count;
  return whole;
}

}  // namespace chorus::characteristics
