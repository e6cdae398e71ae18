#include "tests/judge/plausibility.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "common/body/bones.h"
#include "tests/judge/labelled_error.h"
#include "tests/judge/measures.h"

namespace chorus::bench {
namespace {

using enum JointId;

constexpr double kApart = 0.15;   // [m] limbs closer together cannot be distinguished by position
constexpr double kStands = 0.05;  // [m/s] a slower ankle stands
constexpr double kStance = 0.2;   // [s]
constexpr double kAhead = 0.05;   // [s]
constexpr std::array kArm{ElbowLeft, WristLeft, HandLeft};
constexpr std::array kLeg{KneeLeft, AnkleLeft, FootLeft};
/// Whether left and right of this pair of limbs are swapped; none if it cannot be decided.
std::optional<bool> is_exchanged(const Answer& answer, std::span<const JointId> left_limb) {
  double as_stated = 0.0;
  double exchanged = 0.0;
  Mean apart;
  for (const JointId left : left_limb) {
    const JointId right = mirror(left);
    if (!answer.body[left].seen() || !answer.body[right].seen()) continue;
    const Eigen::Vector3d& l = answer.body[left].position;
    const Eigen::Vector3d& r = answer.body[right].position;
    const Eigen::Vector3d& exact_l = answer.exact[left].position;
    const Eigen::Vector3d& exact_r = answer.exact[right].position;
    as_stated += (l - exact_l).norm() + (r - exact_r).norm();
    exchanged += (l - exact_r).norm() + (r - exact_l).norm();
    apart.add((exact_l - exact_r).norm());
  }
  if (!(apart.value() >= kApart)) return std::nullopt;
  return exchanged < as_stated;
}

/// Whether the true ankle stands still from the previous instant to this one.
bool stands(const Answers& answers, std::size_t at, JointId ankle) {
  const double dt = seconds(answers[at].instant - answers[at - 1].instant);
  const Eigen::Vector3d way =
      answers[at].exact[ankle].position - answers[at - 1].exact[ankle].position;
  return dt > 0 && way.norm() < kStands * dt;
}

using Places = std::vector<Eigen::Vector2d>;

void add_stance(const Places& places, double length, Mean& squares) {
  if (length < kStance || places.size() < 2) return;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& each : places) middle += each / static_cast<double>(places.size());
  for (const Eigen::Vector2d& each : places) squares.add((each - middle).squaredNorm());
}

/// Adds the squared deviations of all stances of one foot.
void add_stances(const Answers& answers, JointId ankle, Mean& squares) {
  Places places;
  std::size_t first = 0;
  for (std::size_t at = 1; at <= answers.size(); ++at) {
    if (at < answers.size() && stands(answers, at, ankle)) {
      const Joint& joint = answers[at].body[ankle];
      // The true ankle may move slowly, so the reported places are taken relative to the true
      // ankle.
      const Eigen::Vector3d off = joint.position - answers[at].exact[ankle].position;
      if (joint.seen()) places.emplace_back(off.x(), off.z());
      continue;
    }
    add_stance(places, seconds(answers[at - 1].instant - answers[first].instant), squares);
    places.clear();
    first = at;
  }
}

/// A joint's true position some time after an instant, linearly interpolated; none at the
/// end.
std::optional<Eigen::Vector3d> later(const Answers& answers, std::size_t at, std::size_t joint) {
  const Timestamp instant = answers[at].instant + from_seconds(kAhead);
  std::size_t after = at + 1;
  while (after < answers.size() && answers[after].instant < instant) ++after;
  if (after >= answers.size()) return std::nullopt;
  const Answer& a = answers[after - 1];
  const Answer& b = answers[after];
  const double share = seconds(instant - a.instant) / seconds(b.instant - a.instant);
  return a.exact.joints[joint].position +
         share * (b.exact.joints[joint].position - a.exact.joints[joint].position);
}

}  // namespace

double limb_label_error_share(const Answers& answers) {
  Mean wrong;
  for (const Answer& answer : answers) {
    const LabelledError whole = labelled_error(answer.body, answer.exact);
    if (whole.exchanged < whole.as_given) continue;
    for (const std::span<const JointId> limb : {std::span(kArm), std::span(kLeg)}) {
      if (const auto exchanged = is_exchanged(answer, limb)) wrong.add(*exchanged ? 1.0 : 0.0);
    }
  }
  return wrong.value();
}

double bone_length_error(const Answers& answers) {
  Mean all;
  for (const JointId child : kLongBones) {
    Mean stated;
    Mean exact;
    for (const Answer& answer : answers) {
      if (const auto length = length_of(answer.body, child)) stated.add(*length);
      if (const auto length = length_of(answer.exact, child)) exact.add(*length);
    }
    if (stated.count > 0 && exact.value() > 0) {
      all.add(std::abs(stated.value() / exact.value() - 1.0));
    }
  }
  return all.value();
}

double foot_slide(const Answers& answers) {
  if (answers.size() < 2) return kNothing;
  Mean squares;
  for (const JointId ankle : {AnkleLeft, AnkleRight}) add_stances(answers, ankle, squares);
  return std::sqrt(squares.value());
}

double held_error(const Answers& answers) {
  Mean mean;
  for (std::size_t at = 0; at < answers.size(); ++at) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!answers[at].body.joints[j].seen()) continue;
      const auto then = later(answers, at, j);
      if (then) mean.add((answers[at].body.joints[j].position - *then).norm());
    }
  }
  return mean.value();
}

}  // namespace chorus::bench
