#include "common/sensor/body_placing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace chorus {
namespace {

constexpr double kMaxPointVariance = 1e4;  // [m^2]

using Across = Eigen::Matrix<double, 3, 2>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kFewest = 8;
// Limits of a joint's distance along its ray [m]; beyond them the fit is rejected.
constexpr double kNearest = 0.3;
constexpr double kFarthest = 50.0;
constexpr double kHuber = 1.5;  // Threshold of Huber's loss [standard deviations].
// Joints farther off their rays than this are left out of the last pass of the fit [standard
// deviations].
constexpr double kCut = 4.0;
// Factor on the standard deviation of the shape for inferred joints.
constexpr double kInferred = 2.0;
// Largest number of iterations in start() and in each pass of refine().
constexpr int kRounds = 8;
constexpr double kConverged = 1e-6;
// Distance from a ray above which start() gives a joint less weight [m].
constexpr double kStartOff = 0.04;
// Median distance from the rays [standard deviations] above which the rays are not of this body.
constexpr double kUseless = 4.0;
// Least determinant of the normal matrix in start(), relative to its mean diagonal cubed; below it,
// all rays are nearly parallel.
constexpr double kLeastSpread = 1e-3;

/// A joint whose ray and position in the shape are both known.
struct Sighting {
  std::size_t joint = 0;
  Eigen::Vector3d ray;
  Across across;  ///< Two axes perpendicular to the ray.
  Eigen::Vector3d shape;
  double shape_variance = 0.0;  ///< Variance of the shape across the ray, per axis [m^2].
  double ray_variance = 0.0;    ///< Variance of the ray's direction, per axis [rad^2].
};

struct Pose {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d of(const Sighting& one) const { return turn * one.shape + shift; }
};

Sighting sighting_of(std::size_t joint, const Joint& ray, const Joint& shape,
                     const PlacingErrors& errors) {
  Sighting one;
  one.joint = joint;
  one.ray = ray.position;
  one.across.col(0) = one.ray.unitOrthogonal();
  one.across.col(1) = one.ray.cross(one.across.col(0));
  one.shape = shape.position;
  const double factor = ray.state == JointState::Inferred ? kInferred : 1.0;
  one.shape_variance = std::pow(factor * errors.across, 2);
  one.ray_variance =
      ray.covariance.known() ? ray.covariance.matrix().trace() / 2.0 : errors.ray * errors.ray;
  return one;
}

std::vector<Sighting> sightings_of(const Skeleton<SensorSpace>& rays,
                                   const Skeleton<SensorSpace>& shape,
                                   const PlacingErrors& errors) {
  std::vector<Sighting> seen;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (rays.joints[i].bears() && shape.joints[i].seen())
      seen.push_back(sighting_of(i, rays.joints[i], shape.joints[i], errors));
  }
  return seen;
}

/// Variance of a joint's distance from its ray, per axis [m^2].
double variance_of(const Sighting& one, const Pose& pose) {
  return one.shape_variance + pose.of(one).squaredNorm() * one.ray_variance;
}

/// A joint's distance from its ray [standard deviations].
double off_the_ray(const Sighting& one, const Pose& pose) {
  return (one.across.transpose() * pose.of(one)).norm() / std::sqrt(variance_of(one, pose));
}

/// R_0 of body_placing.h: the rotation from straight ahead to the mean ray.
Eigen::Quaterniond turn_to(const std::vector<Sighting>& seen) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Sighting& one : seen) sum += one.ray;
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), sum);
}

/// First estimate: with the expected rotation, the shift that brings the shape to the rays, by
/// iteratively reweighted least squares.  None if all rays are nearly parallel.
std::optional<Pose> start(const std::vector<Sighting>& seen) {
  Pose pose{turn_to(seen)};
  std::vector<double> weights(seen.size(), 1.0);
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Eigen::Matrix3d across = weights[i] * seen[i].across * seen[i].across.transpose();
      normal += across;
      right -= across * (pose.turn * seen[i].shape);
    }
    if (!(normal.determinant() > kLeastSpread * std::pow(normal.trace() / 3.0, 3.0)))
      return std::nullopt;
    pose.shift = normal.inverse() * right;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double off = (seen[i].across.transpose() * pose.of(seen[i])).norm();
      weights[i] = std::min(1.0, kStartOff / std::max(off, 1e-9));
    }
  }
  return pose;
}

/// Derivative of a joint's position with respect to the turn (about the shape's origin) and the
/// shift.
Eigen::Matrix<double, 3, 6> motion_of(const Sighting& one, const Pose& pose) {
  const Eigen::Vector3d v = pose.turn * one.shape;
  Eigen::Matrix<double, 3, 6> motion;
  motion << 0.0, v.z(), -v.y(), 1.0, 0.0, 0.0, -v.z(), 0.0, v.x(), 0.0, 1.0, 0.0, v.y(), -v.x(),
      0.0, 0.0, 0.0, 1.0;
  return motion;
}

struct Normal {
  Matrix6d matrix = Matrix6d::Zero();  ///< Information matrix of the turn and the shift.
  Vector6d right = Vector6d::Zero();
};

enum class Loss { Huber, Cut };

double weight_of(double off, Loss loss) {
  if (loss == Loss::Cut && off > kCut) return 0.0;
  return off > kHuber ? kHuber / off : 1.0;
}

/// The rotation vector from the expected orientation to the shape's [rad].
Eigen::Vector3d unexpected_turn(const std::vector<Sighting>& seen, const Pose& pose) {
  const Eigen::AngleAxisd turned(pose.turn * turn_to(seen).conjugate());
  return turned.angle() * turned.axis();
}

Normal normal_of(const std::vector<Sighting>& seen, const Pose& pose, double turn_sigma,
                 Loss loss) {
  Normal normal;
  for (const Sighting& one : seen) {
    const double weight = weight_of(off_the_ray(one, pose), loss) / variance_of(one, pose);
    const Eigen::Matrix<double, 2, 6> motion = one.across.transpose() * motion_of(one, pose);
    normal.matrix += weight * motion.transpose() * motion;
    normal.right -= weight * motion.transpose() * (one.across.transpose() * pose.of(one));
  }
  const double prior = 1.0 / (turn_sigma * turn_sigma);
  normal.matrix.topLeftCorner<3, 3>() += prior * Eigen::Matrix3d::Identity();
  normal.right.head<3>() -= prior * unexpected_turn(seen, pose);
  return normal;
}

/// Takes steps of Gauss-Newton; false when a step cannot be computed.
bool refine(const std::vector<Sighting>& seen, double turn_sigma, Loss loss, Pose& pose) {
  for (int round = 0; round < kRounds; ++round) {
    const Normal normal = normal_of(seen, pose, turn_sigma, loss);
    const Vector6d by = normal.matrix.ldlt().solve(normal.right);
    if (!by.allFinite()) return false;
    const double angle = by.head<3>().norm();
    if (angle > 0.0)
      pose.turn = (Eigen::AngleAxisd(angle, by.head<3>() / angle) * pose.turn).normalized();
    pose.shift += by.tail<3>();
    if (by.norm() < kConverged) break;
  }
  return true;
}

bool fits(const std::vector<Sighting>& seen, const Pose& pose) {
  std::vector<double> off;
  for (const Sighting& one : seen) {
    const double depth = one.ray.dot(pose.of(one));
    if (!(depth > kNearest && depth < kFarthest)) return false;
    off.push_back(off_the_ray(one, pose));
  }
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return *middle < kUseless;
}

/// Sum of the squared distances of joints from their rays [variances] per degree of freedom, at
/// least 1; joints beyond kCut do not count.  Six residuals of 1, as many as the fit has
/// parameters, are added as a prior.
double scale_of(const std::vector<Sighting>& seen, const Pose& pose) {
  double sum = 0.0;
  double count = 0.0;
  for (const Sighting& one : seen) {
    const double off = off_the_ray(one, pose);
    if (off > kCut) continue;
    sum += off * off;
    count += 2.0;
  }
  constexpr double kParameters = 6.0;
  return std::max(1.0, (sum + kParameters) / std::max(count, 1.0));
}

struct Fit {
  Pose pose;
  Matrix6d covariance;
};

std::optional<Fit> fit(const std::vector<Sighting>& seen, const PlacingErrors& errors) {
  auto pose = start(seen);
  if (!pose || !refine(seen, errors.turn, Loss::Huber, *pose) ||
      !refine(seen, errors.turn, Loss::Cut, *pose) || !fits(seen, *pose))
    return std::nullopt;
  const Normal normal = normal_of(seen, *pose, errors.turn, Loss::Cut);
  const Eigen::LDLT<Matrix6d> solver(normal.matrix);
  const Matrix6d covariance = scale_of(seen, *pose) * solver.solve(Matrix6d::Identity());
  if (!covariance.allFinite()) return std::nullopt;
  return Fit{*pose, covariance};
}

void place(Joint& joint, const Sighting& one, const Fit& fit, const PlacingErrors& errors) {
  const double distance = one.ray.dot(fit.pose.of(one));
  const Eigen::Matrix<double, 1, 6> moves = one.ray.transpose() * motion_of(one, fit.pose);
  const double factor = joint.state == JointState::Inferred ? kInferred : 1.0;
  const double along = std::pow(factor * errors.along, 2) +
                       (moves * fit.covariance * moves.transpose()).value() +
                       distance * distance * (std::pow(errors.size, 2) + std::pow(errors.focal, 2));
  const Eigen::Matrix3d across =
      joint.covariance.known()
          ? joint.covariance.matrix()
          : Eigen::Matrix3d(one.ray_variance * one.across * one.across.transpose());
  const Eigen::Matrix3d covariance =
      distance * distance * across + along * one.ray * one.ray.transpose();
  // The joint stays a ray: a larger covariance cannot be written, and a point without one would
  // look precise.
  if (!(covariance.diagonal().maxCoeff() < kMaxPointVariance)) return;
  joint.measurement = Measurement::Point;
  joint.position = distance * one.ray;
  joint.covariance = Covariance(covariance);
}

}  // namespace

std::optional<Skeleton<SensorSpace>> place_body(const Skeleton<SensorSpace>& rays,
                                                const Skeleton<SensorSpace>& shape,
                                                const PlacingErrors& errors) {
  const std::vector<Sighting> seen = sightings_of(rays, shape, errors);
  if (seen.size() < kFewest) return std::nullopt;
  const auto found = fit(seen, errors);
  if (!found) return std::nullopt;
  Skeleton<SensorSpace> placed = rays;
  for (const Sighting& one : seen) place(placed.joints[one.joint], one, *found, errors);
  return placed;
}

}  // namespace chorus
