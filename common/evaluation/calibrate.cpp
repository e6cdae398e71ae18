#include "common/evaluation/calibrate.h"

#include <algorithm>
#include <array>

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "common/base/median.h"
#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;
using inertial::SensorCalibration;

constexpr std::size_t kLeastPairs = 10;
constexpr int kStarts = 12;              // headings tried
constexpr std::size_t kKeptStarts = 3;   // that still lead after the widest scales
constexpr std::size_t kStartPairs = 24;  // which decide between starts
constexpr double kRaceScale = deg(45);   // to which all starts go on
constexpr double kFirstScale = deg(90);  // of the loss
constexpr double kScaleStep = 1.4;       // the loss narrows by this from round to round (GNC)
constexpr double kScalesOfSigma = 3.0;   // where it stops narrowing
constexpr double kMadToSigma = 1.4826;
constexpr double kLeastInliers = 0.5;

/// One pair with the weights of the three parts of its error.
struct Weighted {
  const OrientationPair* pair;
  Eigen::Vector3d weight;  ///< 1 where seen as well as can be, 0 where not seen.
  Eigen::Quaterniond limb_from_world;
  Eigen::Vector3d up_in_limb;  ///< The world's +y.
};

/// pair_error() of many pairs: what is the same for all is computed once.
class Predicted {
 public:
  explicit Predicted(const SensorCalibration& at)
      : world_from_inertial_(about_y(at.heading)),
        sensor_from_limb_(at.limb_from_sensor.conjugate()) {}

  [[nodiscard]] Eigen::Vector3d error_of(const Weighted& each) const {
    return log_map(each.limb_from_world *
                   normalised_or_identity(world_from_inertial_ * each.pair->inertial_from_sensor *
                                          sensor_from_limb_));
  }

 private:
  Eigen::Quaterniond world_from_inertial_;
  Eigen::Quaterniond sensor_from_limb_;
};

/// Relative weights from the stated covariance, never above what skin allows.
std::vector<Weighted> weighted(const OrientationPairs& pairs, const CalibrateOptions& options) {
  std::vector<Weighted> out;
  const std::size_t step =
      std::max<std::size_t>(1, pairs.size() / std::max<std::size_t>(1, options.most_pairs));
  const double floor = options.least_sigma * options.least_sigma;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    const OrientationPair& each = pairs[i];
    if (!is_unit(each.inertial_from_sensor) || !is_unit(each.tracked.world_from_limb)) continue;
    Eigen::Vector3d weight;
    for (int k = 0; k < 3; ++k) {
      const double stated = each.tracked.covariance(k, k);
      weight(k) = floor / (floor + (std::isfinite(stated) ? std::max(0.0, stated) : 0.0));
    }
    if (!each.tracked.twist_seen) weight.y() = 0.0;
    const Eigen::Quaterniond limb_from_world = each.tracked.world_from_limb.conjugate();
    out.push_back({&each, weight, limb_from_world, limb_from_world * Eigen::Vector3d::UnitY()});
  }
  return out;
}

struct Normal {
  Eigen::Matrix4d h = Eigen::Matrix4d::Zero();
  Eigen::Vector4d g = Eigen::Vector4d::Zero();
  double cost = 0.0;
};

double squared(const Weighted& each, const Eigen::Vector3d& error) {
  return (each.weight.array() * error.array().square()).sum();
}

/// Geman-McClure: c^2 r / (c^2 + r) of the squared error r, and its weight.
double robust_cost(double r, double scale) { return scale * scale * r / (scale * scale + r); }
double robust_weight(double r, double scale) {
  const double share = scale * scale / (scale * scale + r);
  return share * share;
}

/// Derivatives of the error after heading (about +y of the world) and mount (exp(m) q^L), to first
/// order: the world's +y in limb axes, and -1 on the mount's side.
Normal normal_of(const std::vector<Weighted>& pairs, const SensorCalibration& at, double scale) {
  Normal out;
  const Predicted predicted(at);
  for (const Weighted& each : pairs) {
    const Eigen::Vector3d error = predicted.error_of(each);
    const double r = squared(each, error);
    Eigen::Matrix<double, 3, 4> j;
    j.col(0) = each.up_in_limb;
    j.rightCols<3>() = -exp_map(error).toRotationMatrix();
    const Eigen::Matrix<double, 4, 3> weighted_j =
        j.transpose() * (robust_weight(r, scale) * each.weight).asDiagonal();
    out.h += weighted_j * j;
    out.g += weighted_j * error;
    out.cost += robust_cost(r, scale);
  }
  return out;
}

void step(SensorCalibration& at, const Normal& normal) {
  const Eigen::Matrix4d damped =
      normal.h + (1e-3 + 1e-3 * normal.h.trace()) * Eigen::Matrix4d::Identity();
  const Eigen::Vector4d by = -damped.ldlt().solve(normal.g);
  if (!by.allFinite()) return;
  at.heading = wrap_angle(at.heading + by(0));
  at.limb_from_sensor = (exp_map(by.tail<3>()) * at.limb_from_sensor).normalized();
}

/// The robust residual about one axis that is seen, of pairs whose whole error is within `gate`.
double residual_sigma(const std::vector<Weighted>& pairs, const SensorCalibration& at,
                      double gate) {
  std::vector<double> sizes;
  const Predicted predicted(at);
  for (const Weighted& each : pairs) {
    const Eigen::Vector3d error = predicted.error_of(each);
    if (squared(each, error) > gate * gate) continue;
    sizes.push_back(std::abs(error.x()));
    sizes.push_back(std::abs(error.z()));
    if (each.weight.y() > 0) sizes.push_back(std::abs(error.y()));
  }
  return sizes.empty() ? 0.0 : kMadToSigma * median(std::move(sizes));
}

/// A mount for this heading from the pairs alone: a mean of those with all axes seen, if there are.
Eigen::Quaterniond first_mount(const std::vector<Weighted>& pairs, double heading) {
  std::vector<Eigen::Quaterniond> each;
  std::vector<double> weights;
  for (const Weighted& w : pairs) {
    each.push_back(w.pair->tracked.world_from_limb.conjugate() * about_y(heading) *
                   w.pair->inertial_from_sensor);
    weights.push_back(0.01 + w.weight.y());
  }
  // The mean by the largest eigenvector of the sum of q q^T (Markley et al. 2007): no signs.
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < each.size(); ++i)
    sum += weights[i] * each[i].coeffs() * each[i].coeffs().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
  return normalised_or_identity(Eigen::Quaterniond(Eigen::Vector4d(solver.eigenvectors().col(3))));
}

constexpr int kRoundsEach = 2;

/// Goes down with the scale of the loss from `from` to `to`.
void narrow(const std::vector<Weighted>& pairs, SensorCalibration& at, double from, double to) {
  for (double scale = from; scale > to; scale /= kScaleStep)
    for (int i = 0; i < kRoundsEach; ++i) step(at, normal_of(pairs, at, scale));
}

void settle(const std::vector<Weighted>& pairs, SensorCalibration& at, double scale) {
  for (int i = 0; i < 4 * kRoundsEach; ++i) step(at, normal_of(pairs, at, scale));
}

/// Evenly thinned.
std::vector<Weighted> some_of(const std::vector<Weighted>& pairs, std::size_t most) {
  std::vector<Weighted> some;
  const std::size_t apart = 1 + (pairs.size() - 1) / most;
  for (std::size_t i = 0; i < pairs.size(); i += apart) some.push_back(pairs[i]);
  return some;
}

double cost_of(const std::vector<Weighted>& pairs, const SensorCalibration& at, double scale) {
  double cost = 0.0;
  const Predicted predicted(at);
  for (const Weighted& each : pairs)
    cost += robust_cost(squared(each, predicted.error_of(each)), scale);
  return cost;
}

struct Start {
  SensorCalibration at;
  double cost = 0.0;
};

void cheapest_first(std::vector<Start>& starts, const std::vector<Weighted>& pairs, double scale) {
  for (Start& start : starts) start.cost = cost_of(pairs, start.at, scale);
  std::ranges::stable_sort(starts, {}, &Start::cost);
}

/// All headings race over some of the pairs while the loss is wide; those that lead then go on, and
/// the best of them is settled with all pairs.
SensorCalibration best_of_starts(const std::vector<Weighted>& pairs, double scale) {
  const std::vector<Weighted> some = some_of(pairs, kStartPairs);
  std::vector<Start> starts(kStarts);
  for (int i = 0; i < kStarts; ++i) {
    SensorCalibration& start = starts[static_cast<std::size_t>(i)].at;
    start.heading = wrap_angle(2.0 * std::numbers::pi * i / kStarts);
    start.limb_from_sensor = first_mount(some, start.heading);
    narrow(some, start, kFirstScale, kRaceScale);
  }
  cheapest_first(starts, some, kRaceScale);
  starts.resize(kKeptStarts);
  for (Start& start : starts) {
    narrow(some, start.at, kRaceScale, scale);
    settle(some, start.at, scale);
    settle(pairs, start.at, scale);
  }
  cheapest_first(starts, pairs, scale);
  return starts.front().at;
}

/// How many independent instants a take is worth.
double independent(const std::vector<Weighted>& pairs, double correlation_time) {
  std::size_t gaps = 0;
  double length = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const double gap = pairs[i].pair->time - pairs[i - 1].pair->time;
    if (gap > 0) length += std::min(gap, correlation_time);
    gaps += gap > 0 ? 1 : 0;
  }
  return std::clamp(length / correlation_time, 1.0, static_cast<double>(gaps + 1));
}

/// Root mean square, over limbs turned evenly in every direction, of the angle by which a
/// prediction errs because of heading and mount.  Of a limb whose twist the tracker never shows,
/// only the direction of the bone is predicted and judged.
double prediction_sigma(const SensorCalibration& calibration, bool twist_seen) {
  double sum = 0.0;
  double count = 0.0;
  for (int tilt = 0; tilt <= 90; tilt += 30) {
    for (int around = 0; around < 360; around += 60) {
      const double a = deg(around);
      const Eigen::Vector3d axis(std::cos(a), 0.0, std::sin(a));
      const Eigen::Quaterniond limb = exp_map(deg(tilt) * axis);
      const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero();
      const Eigen::Matrix3d errs = inertial::prediction_covariance(calibration, limb, zero);
      const Eigen::Vector3d bone = limb * Eigen::Vector3d::UnitY();
      sum += errs.trace() - (twist_seen ? 0.0 : bone.dot(errs * bone));
      count += 1.0;
    }
  }
  return std::sqrt(std::max(0.0, sum / count));
}

void state_errors(CalibrationFit& fit, const std::vector<Weighted>& pairs,
                  const CalibrateOptions& options) {
  const double scale = kScalesOfSigma * fit.sigma;
  const Normal normal = normal_of(pairs, fit.calibration, scale);
  // Each pair counts as the share of an independent instant that it is.
  const double share =
      independent(pairs, options.correlation_time) / static_cast<double>(pairs.size());
  const Eigen::Matrix4d information =
      normal.h * share / (fit.sigma * fit.sigma) +
      Eigen::Matrix4d::Identity() / (std::numbers::pi * std::numbers::pi);
  fit.calibration.covariance = information.inverse();
  std::vector<double> angles;
  double inside = 0.0;
  const Predicted predicted(fit.calibration);
  for (const Weighted& each : pairs) {
    const Eigen::Vector3d error = predicted.error_of(each);
    const double seen =
        std::sqrt((error.array().square() * (each.weight.array() > 0).cast<double>()).sum());
    angles.push_back(seen);
    inside += squared(each, error) < scale * scale * 3.0 ? 1.0 : 0.0;
  }
  fit.inliers = inside / static_cast<double>(pairs.size());
  fit.calibration.residual = median(std::move(angles));
  fit.cost = normal.cost / static_cast<double>(pairs.size());
}

}  // namespace

Eigen::Vector3d pair_error(const SensorCalibration& calibration, const OrientationPair& pair) {
  return log_map(pair.tracked.world_from_limb.conjugate() *
                 predicted_limb(calibration, pair.inertial_from_sensor));
}

Result<CalibrationFit> fit_calibration(const OrientationPairs& pairs,
                                       const CalibrateOptions& options) {
  const std::vector<Weighted> usable = weighted(pairs, options);
  if (usable.size() < kLeastPairs)
    return fail(ErrorCode::InvalidArgument, "calibration",
                fmt::format("has {} instants in which tracker and sensor both know an orientation; "
                            "it takes at least {}",
                            usable.size(), kLeastPairs));
  CalibrationFit fit;
  const double coarse = kScalesOfSigma * 2.0 * options.least_sigma;
  if (options.begin) {
    fit.calibration = *options.begin;
    settle(usable, fit.calibration, coarse);
  } else {
    fit.calibration = best_of_starts(usable, coarse);
  }
  // Gross errors would widen the residual: after the first round only what agrees counts.
  double gate = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3; ++round) {
    fit.sigma = std::max(options.least_sigma, residual_sigma(usable, fit.calibration, gate));
    gate = kScalesOfSigma * std::numbers::sqrt3 * fit.sigma;
    for (int i = 0; i < 4; ++i)
      step(fit.calibration, normal_of(usable, fit.calibration, kScalesOfSigma * fit.sigma));
  }
  state_errors(fit, usable, options);
  const bool twist_seen = std::ranges::any_of(
      usable, [](const Weighted& each) { return each.pair->tracked.twist_seen; });
  fit.calibration.prediction_sigma = prediction_sigma(fit.calibration, twist_seen);
  return fit;
}

Result<CalibrationFit> calibrate_sensor(const OrientationPairs& pairs, const std::string& sensor,
                                        Limb limb, const CalibrateOptions& options) {
  auto fit = fit_calibration(pairs, options);
  const std::string where = fmt::format("{} (sensor {})", words_for(limb), sensor);
  if (!fit) return fail(fit.error().code, where, fit.error().message);
  fit->calibration.sensor = sensor;
  fit->calibration.limb = limb;
  if (fit->inliers < kLeastInliers)
    return fail(
        ErrorCode::InvalidArgument, where,
        fmt::format("agrees with the tracker in {:.0f} % of the take only; is the sensor on "
                    "this limb, and is the limb tracked well here?",
                    100.0 * fit->inliers));
  if (fit->calibration.prediction_sigma <= options.most_prediction) return fit;
  return fail(
      ErrorCode::InvalidArgument, where,
      fmt::format("would predict the limb to within {:.0f} degrees only (at most {:.0f}): {}, "
                  "for a few seconds more",
                  to_deg(fit->calibration.prediction_sigma), to_deg(options.most_prediction),
                  movement_for(limb)));
}

std::string movement_for(Limb limb) {
  const std::string side =
      limb <= Limb::Head
          ? ""
          : (inertial::index_of(limb) < inertial::index_of(mirror_of(limb)) ? "left" : "right");
  switch (limb) {
    case Limb::Pelvis:
    case Limb::Chest:
      return "bend forward and to the side, and turn";
    case Limb::Head:
      return "nod, and tilt the head";
    case Limb::UpperArmLeft:
    case Limb::UpperArmRight:
      return "raise the " + side + " arm ahead and to the side with the elbow bent";
    case Limb::ForearmLeft:
    case Limb::ForearmRight:
      return "bend and stretch the " + side + " elbow, and swing the arm";
    case Limb::HandLeft:
    case Limb::HandRight:
      return "wave the " + side + " hand";
    case Limb::ThighLeft:
    case Limb::ThighRight:
      return "raise the " + side + " knee ahead and to the side";
    case Limb::ShankLeft:
    case Limb::ShankRight:
      return "bend the " + side + " knee and swing the leg aside";
    case Limb::FootLeft:
    case Limb::FootRight:
      return "raise the " + side + " foot, and roll it";
  }
  return "move it in two directions";
}

}  // namespace chorus::evaluation
