#include "fusion-server/fusion/least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/base/median.h"
#include "common/geometry/ray.h"

namespace chorus::fusion {
namespace {

constexpr int kIterations = 20;
constexpr double kSettled = 1e-6;           // [m]
constexpr double kFar = 5.0;                // [standard deviations] beyond this, influence fades
constexpr double kContradicts = 3.0;        // [standard deviations] beyond it, try other starts
constexpr std::size_t kMaxStarts = 12;      // views from which pairs are formed
constexpr double kNearest = 0.1;            // [m] a nearer joint counts as behind the camera
constexpr double kFirstRange = 3.0;         // [m] assumed range of a ray while it is unknown
constexpr double kMinAngle = 1e-5;          // [rad] no camera is more precise
constexpr double kLeastInformation = 1e-2;  // [1/m^2] (10 m); less along any axis counts as none
// Weight of the prior that the scale is 1, in views or in degrees of freedom.
constexpr double kScalePrior = 4.0;
constexpr std::size_t kManyViews = 4;  // from this many on, a median estimates the scale
constexpr double kMedianOf2 = 1.3863;  // median of chi^2 with two degrees of freedom
constexpr double kMedianOf3 = 2.3660;

/// A view as a point with an information matrix; for a ray the information along it is zero.
struct Term {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  bool usable = true;  ///< The joint is in front of this camera.
};

/// Information across the ray [1/rad^2], which is also that in [1/m^2] at a range of 1 m.
Eigen::Matrix3d angular_information(const JointView& view) {
  const Eigen::Vector3d& d = view.joint.position;
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = d.unitOrthogonal();
  basis.col(1) = d.cross(basis.col(0));
  const Eigen::Matrix2d spread = basis.transpose() * view.covariance * basis +
                                 kMinAngle * kMinAngle * Eigen::Matrix2d::Identity();
  return basis * spread.inverse() * basis.transpose();
}

/// All views of a joint; the part of the rays that does not depend on the point is precomputed.
class Terms {
 public:
  explicit Terms(std::span<const JointView> views) : views_(views) {
    for (const JointView& view : views) {
      const bool ray = view.joint.bears();
      fixed_.push_back(ray ? angular_information(view) : view.covariance.inverse());
    }
  }

  [[nodiscard]] std::size_t size() const { return views_.size(); }
  [[nodiscard]] int constraints(std::size_t i) const { return views_[i].joint.bears() ? 2 : 3; }

  /// The view's term at a point; without a point, ranges are kFirstRange.
  [[nodiscard]] Term at(std::size_t i, const std::optional<Eigen::Vector3d>& point) const {
    const JointView& view = views_[i];
    if (!view.joint.bears()) return {view.joint.position, fixed_[i], true};
    const Eigen::Vector3d& d = view.joint.position;
    const double range = point ? d.dot(*point - view.eye) : kFirstRange;
    if (range < kNearest) return {view.eye, Eigen::Matrix3d::Zero(), false};
    return {view.eye + range * d, fixed_[i] / (range * range), true};
  }

 private:
  std::span<const JointView> views_;
  std::vector<Eigen::Matrix3d> fixed_;
};

struct Estimate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

std::optional<Estimate> solve(const Terms& terms, std::span<const double> trust,
                              const std::optional<Eigen::Vector3d>& about) {
  Estimate estimate;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const Term term = terms.at(i, about);
    estimate.information += trust[i] * term.information;
    right += trust[i] * term.information * term.place;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(estimate.information, Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues().minCoeff() > kLeastInformation)) return std::nullopt;
  estimate.position = estimate.information.llt().solve(right);
  return estimate;
}

/// Distance in standard deviations; infinite behind a camera.
double distance_of(const Term& term, const Eigen::Vector3d& point) {
  if (!term.usable) return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d off = point - term.place;
  return std::sqrt(std::max(0.0, off.dot(term.information * off)));
}

double trust_at(double distance, double huber) {
  if (std::isinf(distance)) return 0.0;
  if (distance <= huber || !(huber > 0)) return 1.0;
  const double trust = huber / distance;
  return distance <= kFar ? trust : trust * kFar / distance;
}

struct Loss {
  double huber;
  double scale;  ///< Squared scale of the residuals.
};

std::vector<double> trusts_at(const Terms& terms, const Eigen::Vector3d& point, const Loss& loss) {
  std::vector<double> trust;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double distance = distance_of(terms.at(i, point), point) / std::sqrt(loss.scale);
    trust.push_back(trust_at(distance, loss.huber));
  }
  return trust;
}

/// Cauchy's loss of a point: close enough to the loss of least_squares(), because the influence of
/// distant measurements fades in both.
double loss_at(const Terms& terms, const Eigen::Vector3d& point) {
  constexpr double kBehind = 1e3;
  double loss = 0.0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double distance = std::min(kBehind, distance_of(terms.at(i, point), point));
    loss += std::log1p(distance * distance);
  }
  return loss;
}

/// The joint's position according to the views with trust, without a robust loss; the ranges of the
/// rays are refined twice. None if these views leave the position open.
std::optional<Eigen::Vector3d> plain_start(const Terms& terms, std::span<const double> trust) {
  std::optional<Eigen::Vector3d> point;
  for (int round = 0; round < 3; ++round) {
    const auto estimate = solve(terms, trust, point);
    if (!estimate) return round == 0 ? std::nullopt : point;
    point = estimate->position;
  }
  return point;
}

/// The start with the least loss: `start`, or one computed from one or two views alone.
Eigen::Vector3d best_start(const Terms& terms, Eigen::Vector3d start) {
  double least = loss_at(terms, start);
  const std::size_t count = std::min(terms.size(), kMaxStarts);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i; j < count; ++j) {
      std::vector<double> trust(terms.size(), 0.0);
      trust[i] = trust[j] = 1.0;
      const auto point = plain_start(terms, trust);
      if (!point) continue;
      const double loss = loss_at(terms, *point);
      if (loss >= least) continue;
      least = loss;
      start = *point;
    }
  }
  return start;
}

bool contradictory(const Terms& terms, const Eigen::Vector3d& point) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (distance_of(terms.at(i, point), point) > kContradicts) return true;
  }
  return false;
}

/// Factor by which the typical squared residual exceeds the stated variance, at least 1. It is
/// computed from the median of the residuals, so that outliers do not matter, and drawn towards 1
/// by a prior; with fewer than kManyViews it is 1.
double scale_of(const Terms& terms, const Eigen::Vector3d& point) {
  std::vector<double> ratios;  // residual over its usual value, squared
  double constraints = 0.0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double distance = distance_of(terms.at(i, point), point);
    if (std::isinf(distance)) continue;
    ratios.push_back(distance * distance / (terms.constraints(i) == 2 ? kMedianOf2 : kMedianOf3));
    constraints += terms.constraints(i);
  }
  if (ratios.size() < kManyViews) return 1.0;
  const auto count = static_cast<double>(ratios.size());
  const double found = median(std::move(ratios)) * constraints / (constraints - 3.0);
  return std::max(1.0, (kScalePrior + count * found) / (kScalePrior + count));
}

/// The factor of scale_of() for few views, whose residuals say little: their mean, drawn towards 1
/// by a prior.
double scale_of_few(const Terms& terms, std::span<const double> trust,
                    const Eigen::Vector3d& point) {
  double sum = kScalePrior;
  double freedom = kScalePrior - 3.0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (trust[i] == 0.0) continue;
    const double distance = distance_of(terms.at(i, point), point);
    sum += trust[i] * distance * distance;
    freedom += terms.constraints(i);
  }
  return std::max(1.0, sum / std::max(kScalePrior, freedom));
}

/// Re-weights until the point no longer moves; `scale` is the squared scale of the residuals.
std::optional<LeastSquares> settle(const Terms& terms, const Eigen::Vector3d& start, double huber,
                                   double scale) {
  LeastSquares found{start, {}, trusts_at(terms, start, {huber, scale}), {}};
  auto estimate = solve(terms, found.trust, found.position);
  for (int i = 0; i < kIterations && estimate; ++i) {
    const bool settled = (estimate->position - found.position).norm() < kSettled;
    found.position = estimate->position;
    found.trust = trusts_at(terms, found.position, {huber, scale});
    if (settled) break;
    estimate = solve(terms, found.trust, found.position);
  }
  if (!estimate) return std::nullopt;
  const Eigen::Matrix3d spread = estimate->information.inverse();
  found.covariance = scale * spread;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const Eigen::Matrix3d information = terms.at(i, found.position).information;
    found.pull.push_back(pull_of(found.trust[i] * information, spread));
  }
  return found;
}

}  // namespace

std::optional<LeastSquares> least_squares(std::span<const JointView> views, double huber) {
  const Terms terms(views);
  auto start = plain_start(terms, std::vector<double>(views.size(), 1.0));
  if (!start) return std::nullopt;
  if (views.size() > 2 && huber > 0 && contradictory(terms, *start))
    start = best_start(terms, *start);
  auto found = settle(terms, *start, huber, 1.0);
  if (!found) return std::nullopt;
  if (views.size() < kManyViews) {
    found->covariance *= scale_of_few(terms, found->trust, found->position);
    return found;
  }
  const double scale = scale_of(terms, found->position);
  return scale > 1.0 ? settle(terms, found->position, huber, scale) : found;
}

}  // namespace chorus::fusion
