#include "fusion-server/registration/pair_latency.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "common/base/units.h"
#include "fusion-server/registration/pairs.h"
#include "fusion-server/registration/student_fit.h"

namespace chorus::registration {
namespace {

// Turn, shift, latency.
constexpr int kUnknowns = 7;
constexpr int kLatency = 6;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using LatencyNormal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Design = Eigen::Matrix<double, 3, kUnknowns>;

constexpr std::size_t kMostSights = 300;
constexpr std::size_t kLeastSights = 30;
constexpr std::size_t kReach = 2;       // frames to either side from which a velocity is taken
constexpr double kMostReach = 0.3;      // [s] between these two
constexpr double kErrorLasts = 2.0;     // [s] after which a sensor's error is nearly independent
constexpr double kTailFreedom = 4.0;    // of the Student-t
constexpr double kTurnSigma = deg(10);  // how far the pair's place may be wrong
constexpr double kShiftSigma = 0.3;     // [m]
constexpr double kMostLatency = 0.3;    // [s]
constexpr double kWidened = 1.3;
constexpr double kLeastSignal = 0.02;  // with less, velocities are noise
constexpr double kLittleMoved = 0.25;  // sigmas by which another round would change little
constexpr int kLatencyFits = 3;
constexpr int kStudentRounds = 8;

/// One frame of the source and the target at that time, both in the target's space.
struct Sight {
  double time = 0.0;  ///< [s]
  std::uint32_t seen = 0;
  std::array<Eigen::Vector3d, kJointCount> target;
  std::array<Eigen::Vector3d, kJointCount> source;

  [[nodiscard]] bool has(std::size_t slot) const { return (seen >> slot & 1U) != 0; }
};

/// A frame's part of the normal equations.
struct Part {
  LatencyNormal normal = LatencyNormal::Zero();
  Unknowns right = Unknowns::Zero();
  double squares = 0.0;
  double values = 0.0;  ///< Number of residuals.
  /// Of the information about the latency, what is only the noise of velocities: that of the mean
  /// of both views less the product of the two, whose noises are independent.
  double noise = 0.0;
};

std::vector<Sight> sights_of(const Walker& target, const Walker& source,
                             const Eigen::Isometry3d& target_from_source, double later,
                             Duration max_gap) {
  TrailReader reader(target.trail, max_gap);
  std::vector<Sight> sights;
  for (const TrailFrame& frame : source.trail.frames) {
    const auto other = reader.at(frame.captured - from_seconds(later));
    if (!other) continue;
    Sight sight;
    sight.time = seconds(frame.captured - source.trail.frames.front().captured);
    sight.seen = frame.seen & other->frame.seen;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!sight.has(i)) continue;
      sight.target[i] = other->frame.points[i];
      sight.source[i] = target_from_source * frame.points[i];
    }
    sights.push_back(sight);
  }
  return sights;
}

/// Inverse covariance of the difference of two views of a joint, larger along each line of sight.
Eigen::Matrix3d weight_of(const Eigen::Vector3d& target, const Eigen::Vector3d& source_ray,
                          double sigma, double along_ratio) {
  const double more = along_ratio * along_ratio - 1.0;
  const Eigen::Vector3d ray = target.normalized();
  const Eigen::Matrix3d covariance = 2.0 * Eigen::Matrix3d::Identity() +
                                     more * ray * ray.transpose() +
                                     more * source_ray * source_ray.transpose();
  return covariance.inverse() / (sigma * sigma);
}

Eigen::Matrix3d skew(const Eigen::Vector3d& x) {
  Eigen::Matrix3d matrix;
  matrix << 0, -x.z(), x.y(), x.z(), 0, -x.x(), -x.y(), x.x(), 0;
  return matrix;
}

class Regression {
 public:
  Regression(const Eigen::Isometry3d& target_from_source, const RegistrationConfig& config)
      : source_eye_(target_from_source.translation()), along_ratio_(config.along_ratio) {}

  void add(const std::vector<Sight>& sights) {
    const std::size_t step = std::max<std::size_t>(1, sights.size() / kMostSights);
    for (std::size_t i = kReach + step; i + kReach < sights.size(); i += step)
      add(sights, i - step, i);
  }

  /// Latency and its sigma, as a correction.
  [[nodiscard]] std::optional<PairLatency> solve() const {
    if (parts_.size() < kLeastSights) return std::nullopt;
    Unknowns prior;
    prior << Eigen::Vector3d::Constant(1.0 / (kTurnSigma * kTurnSigma)),
        Eigen::Vector3d::Constant(1.0 / (kShiftSigma * kShiftSigma)),
        1.0 / (kMostLatency * kMostLatency);
    std::vector<double> weights(parts_.size(), 1.0);
    double variance = 1.0;
    Unknowns found = Unknowns::Zero();
    LatencyNormal inverse;
    for (int i = 0; i < kStudentRounds; ++i) {
      LatencyNormal normal = prior.asDiagonal();
      Unknowns right = Unknowns::Zero();
      double noise = 0.0;
      for (std::size_t k = 0; k < parts_.size(); ++k) {
        normal += weights[k] / variance * parts_[k].normal;
        noise += weights[k] / variance * parts_[k].noise;
        right += weights[k] / variance * parts_[k].right;
      }
      const double signal = normal(kLatency, kLatency) - noise;
      if (signal < kLeastSignal * normal(kLatency, kLatency)) return std::nullopt;
      normal(kLatency, kLatency) = signal;
      inverse = normal.ldlt().solve(LatencyNormal::Identity());
      found = inverse * right;
      reweigh(found, weights, variance);
    }
    std::vector<Eigen::Vector3d> scores;
    double squares = 0.0;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Unknowns left = parts_[k].right - parts_[k].normal * found;
      const double score = weights[k] / variance * inverse.row(kLatency).dot(left);
      scores.emplace_back(score, 0.0, 0.0);
      squares += score * score;
    }
    const double by_prior = inverse.row(kLatency).cwiseAbs2().dot(prior.transpose());
    return PairLatency{found[kLatency],
                       kWidened * std::sqrt(squares * inflation_of(scores) + by_prior)};
  }

 private:
  struct Row {
    Eigen::Vector3d residual;
    Design design;
    Eigen::Vector3d target_velocity;
    Eigen::Vector3d source_velocity;
  };

  [[nodiscard]] static std::optional<Row> row(const std::vector<Sight>& sights, std::size_t i,
                                              std::size_t slot) {
    const Sight& before = sights[i - kReach];
    const Sight& after = sights[i + kReach];
    const Sight& here = sights[i];
    const double apart = after.time - before.time;
    if (!before.has(slot) || !here.has(slot) || !after.has(slot) || apart > kMostReach)
      return std::nullopt;
    Row row;
    row.target_velocity = (after.target[slot] - before.target[slot]) / apart;
    row.source_velocity = (after.source[slot] - before.source[slot]) / apart;
    row.residual = here.source[slot] - here.target[slot];
    row.design.leftCols<3>() = -skew(here.source[slot]);
    row.design.middleCols<3>(3).setIdentity();
    row.design.col(kLatency) = -0.5 * (row.target_velocity + row.source_velocity);
    return row;
  }

  void add(const std::vector<Sight>& sights, std::size_t before, std::size_t here) {
    const double kept = std::exp(-(sights[here].time - sights[before].time) / kErrorLasts);
    Part part;
    const auto slots = slots_of(JointChoice::All);
    for (std::size_t slot = 0; slot < slots.size(); ++slot) {
      auto now = row(sights, here, slot);
      if (!now) continue;
      const auto then = row(sights, before, slot);
      if (!then) continue;
      now->residual -= kept * then->residual;
      now->design -= kept * then->design;
      now->target_velocity -= kept * then->target_velocity;
      now->source_velocity -= kept * then->source_velocity;
      const Eigen::Vector3d ray = (sights[here].source[slot] - source_eye_).normalized();
      const Eigen::Matrix3d weight =
          weight_of(sights[here].target[slot], ray, slots[slot].sigma, along_ratio_);
      const Eigen::Matrix<double, kUnknowns, 3> weighted = now->design.transpose() * weight;
      part.normal += weighted * now->design;
      part.noise += now->design.col(kLatency).dot(weight * now->design.col(kLatency)) -
                    now->target_velocity.dot(weight * now->source_velocity);
      part.right += weighted * now->residual;
      part.squares += now->residual.dot(weight * now->residual);
      part.values += 3.0;
    }
    if (part.values > 0.0) parts_.push_back(part);
  }

  void reweigh(const Unknowns& found, std::vector<double>& weights, double& variance) const {
    double sum = 0.0;
    double values = 0.0;
    std::vector<double> squares(parts_.size());
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Part& part = parts_[k];
      squares[k] = std::max(
          0.0, part.squares - 2.0 * found.dot(part.right) + found.dot(part.normal * found));
      sum += weights[k] * squares[k];
      values += part.values;
    }
    variance = std::max(1e-6, sum / values);
    for (std::size_t k = 0; k < parts_.size(); ++k)
      weights[k] =
          (kTailFreedom + 3.0) / (kTailFreedom + 3.0 * squares[k] / (parts_[k].values * variance));
  }

  Eigen::Vector3d source_eye_;
  double along_ratio_;
  std::vector<Part> parts_;
};

}  // namespace

std::optional<PairLatency> pair_latency(const Walker& target, const Walker& source,
                                        const Eigen::Isometry3d& target_from_source,
                                        const RegistrationConfig& config) {
  PairLatency sum;
  for (int round = 0; round < kLatencyFits; ++round) {
    Regression regression(target_from_source, config);
    regression.add(sights_of(target, source, target_from_source, sum.latency, config.max_gap));
    const auto more = regression.solve();
    if (!more) return std::nullopt;
    sum.latency = std::clamp(sum.latency + more->latency, -kMostLatency, kMostLatency);
    sum.sigma = more->sigma;
    if (std::abs(more->latency) < kLittleMoved * more->sigma) break;
  }
  return sum;
}

}  // namespace chorus::registration
