#include "tests/judge/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "common/base/median.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "tests/judge/measures.h"

namespace chorus::bench {
namespace {

constexpr double kJump = 0.08;  // [m] a jump exceeds the true step by this
// Instants more than this many usual steps apart are not successive.
constexpr double kNextTo = 1.5;
constexpr double kMinLag = -0.2;  // [s]
constexpr double kMaxLag = 0.4;   // [s]

using enum JointId;

/// Usual time between successive instants [s].
double usual_step(const Answers& answers) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < answers.size(); ++i) {
    steps.push_back(seconds(answers[i].instant - answers[i - 1].instant));
  }
  if (steps.empty()) return 0.0;
  return chorus::median(std::move(steps));
}

/// How far a joint that is seen at two successive instants moved between them.
struct Step {
  std::size_t joint = 0;
  double dt = 0.0;         ///< Time between the instants [s].
  Eigen::Vector3d stated;  ///< According to the answers [m].
  Eigen::Vector3d exact;   ///< In truth [m].
};

template <class Visit>
void each_step(const Answers& answers, const Visit& visit) {
  const double usual = usual_step(answers);
  for (std::size_t i = 1; i < answers.size(); ++i) {
    const Answer& before = answers[i - 1];
    const Answer& after = answers[i];
    const double dt = seconds(after.instant - before.instant);
    if (!(dt > 0) || dt > kNextTo * usual) continue;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!before.body.joints[j].seen() || !after.body.joints[j].seen()) continue;
      visit(Step{j, dt, after.body.joints[j].position - before.body.joints[j].position,
                 after.exact.joints[j].position - before.exact.joints[j].position});
    }
  }
}

/// Rotates the body's own frame (z where it faces) into the world.
Eigen::Quaterniond world_from_body(const Skeleton<WorldSpace>& exact) {
  const Eigen::Vector3d to_left = exact[ShoulderLeft].position - exact[ShoulderRight].position;
  return about_y(std::atan2(-to_left.z(), to_left.x()));
}

template <class Visit>
void each_error(const Answers& answers, JointGroup group, const Visit& visit) {
  for (const Answer& answer : answers) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!belongs(static_cast<JointId>(j), group) || !answer.body.joints[j].seen()) continue;
      visit(answer, j,
            Eigen::Vector3d(answer.body.joints[j].position - answer.exact.joints[j].position));
    }
  }
}

/// Standard deviation over mean of one bone's length; NaN below two samples.
double variation_of(const Answers& answers, JointId child) {
  Mean mean;
  for (const Answer& answer : answers) {
    if (const auto length = length_of(answer.body, child)) mean.add(*length);
  }
  Mean square;
  for (const Answer& answer : answers) {
    const auto length = length_of(answer.body, child);
    if (length) square.add((*length - mean.value()) * (*length - mean.value()));
  }
  if (square.count < 2 || !(mean.value() > 0)) return kNothing;
  return std::sqrt(square.value()) / mean.value();
}

/// Distances of the labelled pairs from the truth, as given and with left and right swapped.
struct Labelling {
  double as_stated = 0.0;
  double exchanged = 0.0;
  std::size_t pairs = 0;
};

Labelling labelling_of(const Answer& answer) {
  Labelling labelling;
  for (const auto& [left, right] : kMirrorPairs) {
    const Joint& l = answer.body[left];
    const Joint& r = answer.body[right];
    if (!l.seen() || !r.seen()) continue;
    const Eigen::Vector3d& exact_left = answer.exact[left].position;
    const Eigen::Vector3d& exact_right = answer.exact[right].position;
    labelling.as_stated += (l.position - exact_left).norm() + (r.position - exact_right).norm();
    labelling.exchanged += (l.position - exact_right).norm() + (r.position - exact_left).norm();
    ++labelling.pairs;
  }
  return labelling;
}

/// Correlation of reported steps with the true ones `lag` instants earlier.
double correlation(const Answers& answers, std::ptrdiff_t lag) {
  double both = 0.0;
  double stated_square = 0.0;
  double exact_square = 0.0;
  const auto count = static_cast<std::ptrdiff_t>(answers.size());
  for (std::ptrdiff_t i = 1; i < count; ++i) {
    if (i - lag < 1 || i - lag >= count) continue;
    const auto at = [&](std::ptrdiff_t k) -> const Answer& {
      return answers[static_cast<std::size_t>(k)];
    };
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Joint& now = at(i).body.joints[j];
      const Joint& before = at(i - 1).body.joints[j];
      if (!now.seen() || !before.seen()) continue;
      const Eigen::Vector3d stated = now.position - before.position;
      if (stated.norm() > kJump) continue;  // a jump is not motion
      const Eigen::Vector3d exact =
          at(i - lag).exact.joints[j].position - at(i - lag - 1).exact.joints[j].position;
      both += stated.dot(exact);
      stated_square += stated.squaredNorm();
      exact_square += exact.squaredNorm();
    }
  }
  const double scale = std::sqrt(stated_square * exact_square);
  return scale > 0 ? both / scale : kNothing;
}

/// Where between -1 and 1 a parabola through three values has its maximum.
double top_of(double before, double middle, double after) {
  const double bend = before - 2.0 * middle + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0.0;
}

}  // namespace

bool belongs(JointId joint, JointGroup group) {
  constexpr std::array kCentre{SpineBase,    SpineMid,      SpineShoulder, Neck,    Head,
                               ShoulderLeft, ShoulderRight, HipLeft,       HipRight};
  if (group == JointGroup::All) return true;
  const bool centre = std::ranges::find(kCentre, joint) != kCentre.end();
  return centre == (group == JointGroup::Centre);
}

double mpjpe(const Answers& answers, JointGroup group) {
  Mean mean;
  each_error(answers, group,
             [&](const Answer&, std::size_t, const Eigen::Vector3d& off) { mean.add(off.norm()); });
  return mean.value();
}

double bias_free_mpjpe(const Answers& answers, JointGroup group) {
  std::array<Eigen::Vector3d, kJointCount> sum;
  sum.fill(Eigen::Vector3d::Zero());
  std::array<double, kJointCount> count{};
  each_error(answers, group, [&](const Answer& answer, std::size_t j, const Eigen::Vector3d& off) {
    sum[j] += world_from_body(answer.exact).inverse() * off;
    count[j] += 1.0;
  });
  Mean mean;
  each_error(answers, group, [&](const Answer& answer, std::size_t j, const Eigen::Vector3d& off) {
    mean.add((off - world_from_body(answer.exact) * (sum[j] / count[j])).norm());
  });
  return mean.value();
}

double jitter_at_rest(const Answers& answers, JointGroup group) {
  Mean mean;
  each_step(answers, [&](const Step& step) {
    if (!belongs(static_cast<JointId>(step.joint), group)) return;
    if (step.exact.norm() < kRest * step.dt) mean.add((step.stated - step.exact).norm());
  });
  return mean.value();
}

double bone_variation(const Answers& answers) {
  Mean mean;
  for (const JointId child : kLongBones) {
    const double variation = variation_of(answers, child);
    if (std::isfinite(variation)) mean.add(variation);
  }
  return mean.value();
}

double jumps_per_minute(const Answers& answers) {
  if (answers.size() < 2) return kNothing;
  std::size_t jumps = 0;
  each_step(answers, [&](const Step& step) {
    jumps += step.stated.norm() - step.exact.norm() > kJump ? 1U : 0U;
  });
  const double minutes = seconds(answers.back().instant - answers.front().instant) / 60.0;
  return static_cast<double>(jumps) / minutes;
}

double label_error_share(const Answers& answers) {
  Mean wrong;
  for (const Answer& answer : answers) {
    const Labelling labelling = labelling_of(answer);
    if (labelling.pairs > 0) wrong.add(labelling.exchanged < labelling.as_stated ? 1.0 : 0.0);
  }
  return wrong.value();
}

double latency(const Answers& answers) {
  const double step = usual_step(answers);
  if (!(step > 0)) return kNothing;
  const auto least = static_cast<std::ptrdiff_t>(std::floor(kMinLag / step));
  const auto most = static_cast<std::ptrdiff_t>(std::ceil(kMaxLag / step));
  std::ptrdiff_t best = 0;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::ptrdiff_t lag = least; lag <= most; ++lag) {
    const double found = correlation(answers, lag);
    if (!(found > highest)) continue;
    highest = found;
    best = lag;
  }
  if (!(highest > 0)) return kNothing;
  const double between =
      top_of(correlation(answers, best - 1), highest, correlation(answers, best + 1));
  return (static_cast<double>(best) + between) * step;
}

double coverage(const Answers& answers) {
  Mean seen;
  for (const Answer& answer : answers) {
    for (const Joint& joint : answer.body.joints) seen.add(joint.seen() ? 1.0 : 0.0);
  }
  return seen.value();
}

}  // namespace chorus::bench
