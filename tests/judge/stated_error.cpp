#include "tests/judge/stated_error.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "tests/judge/measures.h"

namespace chorus::bench {
namespace {

constexpr double kChi2Of3 = 7.8147;  // 95 % with three degrees of freedom

/// Speed of a true joint at an instant [m/s]; 0 if there is only one instant.
double speed_at(const Answers& answers, std::size_t at, std::size_t joint) {
  const std::size_t before = at == 0 ? 0 : at - 1;
  const std::size_t after = std::min(at + 1, answers.size() - 1);
  const double dt = seconds(answers[after].instant - answers[before].instant);
  const Eigen::Vector3d way =
      answers[after].exact.joints[joint].position - answers[before].exact.joints[joint].position;
  return dt > 0 ? way.norm() / dt : 0.0;
}

bool is_asked(const Answers& answers, std::size_t at, std::size_t joint, const Sighted& which) {
  const std::size_t views = answers[at].views[joint];
  if (views < which.least_views || views > which.most_views) return false;
  if (which.motion == Sighted::Motion::Any) return true;
  const bool rests = speed_at(answers, at, joint) < kRest;
  return rests == (which.motion == Sighted::Motion::Rest);
}

template <class Visit>
void each_stated(const Answers& answers, const Sighted& which, const Visit& visit) {
  for (std::size_t at = 0; at < answers.size(); ++at) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Joint& joint = answers[at].body.joints[j];
      if (!joint.seen() || !joint.covariance.known()) continue;
      if (!is_asked(answers, at, j, which)) continue;
      visit(Eigen::Vector3d(joint.position - answers[at].exact.joints[j].position),
            joint.covariance.matrix());
    }
  }
}

/// e^T P^-1 e; infinite if the stated matrix is not a covariance.
double distance_of(const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> root(covariance);
  if (root.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return off.dot(root.solve(off));
}

}  // namespace

double nees(const Answers& answers, const Sighted& which) {
  double sum = 0.0;
  double count = 0.0;
  each_stated(answers, which, [&](const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
    sum += distance_of(off, covariance) / 3.0;
    count += 1.0;
  });
  return count > 0 ? sum / count : kNothing;
}

double ball95_share(const Answers& answers, const Sighted& which) {
  double inside = 0.0;
  double count = 0.0;
  each_stated(answers, which, [&](const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
    inside += distance_of(off, covariance) <= kChi2Of3 ? 1.0 : 0.0;
    count += 1.0;
  });
  return count > 0 ? inside / count : kNothing;
}

double sharpness(const Answers& answers, const Sighted& which) {
  double stated = 0.0;
  double actual = 0.0;
  each_stated(answers, which, [&](const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
    stated += covariance.trace();
    actual += off.squaredNorm();
  });
  return actual > 0 ? std::sqrt(stated / actual) : kNothing;
}

}  // namespace chorus::bench
