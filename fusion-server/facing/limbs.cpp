#include "fusion-server/facing/limbs.h"

#include <array>
#include <utility>
#include <vector>

#include "common/body/bones.h"

namespace chorus::facing {
namespace {

using enum JointId;

// Number of other views that are needed to decide which of two is wrong.
constexpr std::size_t kEnough = 2;

/// For each pair of kSidePairs, the left joints that are swapped together with it.
const std::array<std::vector<JointId>, kSidePairs.size()> kHangsOn{{
    {ShoulderLeft},
    {HipLeft},
    {ElbowLeft},
    {KneeLeft},
    {WristLeft, HandLeft, HandTipLeft, ThumbLeft},
    {AnkleLeft, FootLeft},
}};

struct Places {
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

bool shows(const SensorView& view, JointId left) {
  return view.skeleton[left].seen() && view.skeleton[mirror(left)].seen();
}

Places places_of(const SensorView& view, JointId left) {
  return {view.skeleton[left].position, view.skeleton[mirror(left)].position};
}

/// The mean of the other views that show the pair, and the number of these views.
std::pair<Places, std::size_t> others(const Person& person, std::size_t self, JointId left) {
  Places mean;
  std::size_t count = 0;
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    if (v == self || !shows(person.views[v], left)) continue;
    const Places places = places_of(person.views[v], left);
    mean.left += places.left;
    mean.right += places.right;
    ++count;
  }
  if (count == 0) return {mean, count};
  mean.left /= static_cast<double>(count);
  mean.right /= static_cast<double>(count);
  return {mean, count};
}

double misfit(const Places& a, const Places& b) {
  return (a.left - b.left).squaredNorm() + (a.right - b.right).squaredNorm();
}

bool fits_exchanged(const Places& seen, const Places& mean, const LimbLimits& limits) {
  return (mean.left - mean.right).norm() > limits.apart &&
         misfit({seen.right, seen.left}, mean) < limits.better * misfit(seen, mean);
}

void exchange_pair(Skeleton<WorldSpace>& body, std::size_t pair) {
  for (const JointId left : kHangsOn[pair]) {
    std::swap(body[left], body[mirror(left)]);
    body[left].orientation.coeffs().setZero();
    body[mirror(left)].orientation.coeffs().setZero();
  }
}

void count_as_guessed(Skeleton<WorldSpace>& body, std::size_t pair) {
  for (const JointId left : kHangsOn[pair]) {
    for (Joint* joint : {&body[left], &body[mirror(left)]}) {
      if (joint->state == JointState::Tracked) joint->state = JointState::Inferred;
    }
  }
}

/// True if the pair is clearly opposite to the recently agreed direction.
bool contradicts(const Places& seen, const Eigen::Vector3d& held, const LimbLimits& limits) {
  const Eigen::Vector3d span = seen.left - seen.right;
  return span.norm() > limits.apart && held.norm() > limits.apart &&
         span.dot(held) < -0.5 * span.norm() * held.norm();
}

enum class Verdict { Right, Exchanged, Doubtful };

Verdict judge(const Person& person, std::size_t view, std::size_t pair, const Spans& held,
              const LimbLimits& limits) {
  const JointId left = kSidePairs[pair];
  if (!shows(person.views[view], left)) return Verdict::Right;
  const Places seen = places_of(person.views[view], left);
  if ((seen.left - seen.right).norm() <= limits.apart) return Verdict::Right;
  const auto [mean, count] = others(person, view, left);
  if (count >= kEnough)
    return fits_exchanged(seen, mean, limits) ? Verdict::Exchanged : Verdict::Right;
  return contradicts(seen, held[pair], limits) ? Verdict::Doubtful : Verdict::Right;
}

}  // namespace

void mend_limbs(Person& person, const Spans& held, const LimbLimits& limits) {
  if (!limits.mend) return;
  const Person before = person;
  for (std::size_t view = 0; view < person.views.size(); ++view) {
    for (std::size_t pair = 0; pair < kSidePairs.size(); ++pair) {
      const Verdict verdict = judge(before, view, pair, held, limits);
      Skeleton<WorldSpace>& body = person.views[view].skeleton;
      if (verdict == Verdict::Exchanged) exchange_pair(body, pair);
      if (verdict == Verdict::Doubtful) count_as_guessed(body, pair);
    }
  }
}

}  // namespace chorus::facing
