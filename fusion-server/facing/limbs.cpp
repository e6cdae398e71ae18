#include "fusion-server/facing/limbs.h"

#include <array>
#include <utility>
#include <vector>

#include "common/body/bones.h"

namespace chorus::facing {
namespace {

using enum JointId;

// Number of other views that are needed to decide that a view has a pair swapped.
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

/// A view that shows both joints of a pair.
struct Sight {
  std::size_t view = 0;  ///< Index into Person::views.
  Places places;
};

/// The views that show the pair: a table of its own, because every view is compared with all others
/// and views are large.
std::vector<Sight> sights_of(const Person& person, JointId left) {
  const JointId right = mirror(left);
  std::vector<Sight> sights;
  sights.reserve(person.views.size());
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    const Skeleton<WorldSpace>& body = person.views[v].skeleton;
    if (body[left].seen() && body[right].seen())
      sights.push_back({v, {body[left].position, body[right].position}});
  }
  return sights;
}

/// The mean of all views except that of index `self`.
Places mean_of_others(const std::vector<Sight>& sights, std::size_t self) {
  Places mean;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (i == self) continue;
    mean.left += sights[i].places.left;
    mean.right += sights[i].places.right;
  }
  const auto count = static_cast<double>(sights.size() - 1);
  mean.left /= count;
  mean.right /= count;
  return mean;
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

Verdict judge(const std::vector<Sight>& sights, std::size_t self, const Eigen::Vector3d& held,
              const LimbLimits& limits) {
  const Places& seen = sights[self].places;
  if ((seen.left - seen.right).norm() <= limits.apart) return Verdict::Right;
  if (sights.size() > kEnough)
    return fits_exchanged(seen, mean_of_others(sights, self), limits) ? Verdict::Exchanged
                                                                      : Verdict::Right;
  return contradicts(seen, held, limits) ? Verdict::Doubtful : Verdict::Right;
}

}  // namespace

void mend_limbs(Person& person, const Spans& held, const LimbLimits& limits) {
  if (!limits.mend) return;
  for (std::size_t pair = 0; pair < kSidePairs.size(); ++pair) {
    const std::vector<Sight> sights = sights_of(person, kSidePairs[pair]);
    for (std::size_t i = 0; i < sights.size(); ++i) {
      const Verdict verdict = judge(sights, i, held[pair], limits);
      Skeleton<WorldSpace>& body = person.views[sights[i].view].skeleton;
      if (verdict == Verdict::Exchanged) exchange_pair(body, pair);
      if (verdict == Verdict::Doubtful) count_as_guessed(body, pair);
    }
  }
}

}  // namespace chorus::facing
