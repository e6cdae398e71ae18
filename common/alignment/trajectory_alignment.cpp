#include "common/alignment/trajectory_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "common/alignment/clock_search.h"
#include "common/base/median.h"
#include "common/base/units.h"
#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"

namespace chorus::alignment {
namespace {

constexpr std::size_t kLeastSamples = 60;
constexpr double kLeastSpread = 0.3;  // RMS distance of the walk from its middle, on the floor [m]
constexpr double kMostMisfit = 0.15;  // median of the residuals [m]
constexpr double kMostYawSigma = deg(1.0);
constexpr double kMostClockSigma = 0.03;  // [s]
constexpr double kOffsetPrior = 0.5;      // of the marker's offset, per axis [m]
constexpr int kRounds = 25;
constexpr double kMedianToSigma = 1.538;  // median of the norm of a 3-D standard Gaussian
constexpr double kCutoff = 3.0;           // where the weight of a residual is a quarter [sigma]
constexpr double kLeastScale = 1e-4;      // [m]

// Turn (3), shift (3), clock (1), marker (3).
constexpr int kClock = 6;
constexpr int kMarker = 7;
constexpr int kUnknowns = 10;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Jacobian = Eigen::Matrix<double, 3, kUnknowns>;

/// One of our points beside the reference at the same time.
struct Pair {
  double time = 0.0;
  Eigen::Vector3d ours = Eigen::Vector3d::Zero();
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();
  Eigen::Vector3d speed = Eigen::Vector3d::Zero();  ///< Of the reference [m/s].
  /// The axes of the marker's offset: in the reference's world, or (of the body) in ours.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
};

/// What is estimated.
struct State {
  Eigen::Isometry3d ours_from_reference = Eigen::Isometry3d::Identity();
  double offset = 0.0;
  Eigen::Vector3d marker = Eigen::Vector3d::Zero();
};

struct Problem {
  const Trace& ours;
  const Trace& reference;
  const AlignmentConfig& config;
  bool poses = false;  ///< The marker's offset is in the axes of the reference.
};

std::vector<Pair> pairs_at(const Problem& problem, double offset) {
  constexpr double kApart = 0.02;  // [s]
  std::vector<Pair> pairs;
  for (const TracePoint& point : problem.ours) {
    const double time = point.time - offset;
    const double gap = problem.config.max_gap;
    const auto there = trace_at(problem.reference, time, gap);
    const auto before = trace_at(problem.reference, time - kApart, gap);
    const auto after = trace_at(problem.reference, time + kApart, gap);
    const auto& axes = problem.poses ? there : std::optional<TracePoint>(point);
    const bool lacks_axes = problem.config.marker_offset && !(axes && axes->axes);
    if (!there || !before || !after || lacks_axes) continue;
    Pair pair{point.time, point.place, there->place,
              (after->place - before->place) / (2.0 * kApart)};
    if (problem.config.marker_offset) pair.axes = axes->axes->toRotationMatrix();
    pairs.push_back(pair);
  }
  return pairs;
}

/// Axes of the marker's offset in our world: residual = ours - lever * marker - (R x + t).
Eigen::Matrix3d lever(const Problem& problem, const State& state, const Pair& pair) {
  return problem.poses ? Eigen::Matrix3d(state.ours_from_reference.linear() * pair.axes)
                       : pair.axes;
}

Eigen::Vector3d residual(const Problem& problem, const State& state, const Pair& pair) {
  return pair.ours - lever(problem, state, pair) * state.marker -
         state.ours_from_reference * pair.reference;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return out;
}

/// Derivatives of the residual; turns are about `middle`.
Jacobian derivative(const Problem& problem, const State& state, const Pair& pair,
                    const Eigen::Vector3d& middle) {
  const Eigen::Matrix3d axes = lever(problem, state, pair);
  Eigen::Vector3d arm = state.ours_from_reference * pair.reference - middle;
  if (problem.poses) arm += axes * state.marker;
  Jacobian out;
  out.block<3, 3>(0, 0) = cross_matrix(arm);
  out.block<3, 3>(0, 3) = -Eigen::Matrix3d::Identity();
  out.col(kClock) = state.ours_from_reference.linear() * pair.speed;
  out.block<3, 3>(0, kMarker) = -axes;
  return out;
}

/// Which of the unknowns are estimated.
Eigen::Array<bool, kUnknowns, 1> free_of(const Problem& problem) {
  Eigen::Array<bool, kUnknowns, 1> free;
  free.setConstant(true);
  if (!problem.config.full) free[0] = free[2] = false;
  if (!problem.config.marker_offset) free.tail<3>().setConstant(false);
  // Up is the same as a shift of the world while the person stays upright.
  if (!problem.poses) free[kMarker + 1] = false;
  return free;
}

double robust_weight(double off, double scale) {
  const double ratio = off / (kCutoff * scale);
  return 1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));
}

double scale_of(const std::vector<Eigen::Vector3d>& residuals) {
  std::vector<double> norms;
  norms.reserve(residuals.size());
  for (const Eigen::Vector3d& each : residuals) norms.push_back(each.norm());
  return std::max(kLeastScale, median(std::move(norms)) / kMedianToSigma);
}

struct Solved {
  State state;
  std::vector<Pair> pairs;
  std::vector<Eigen::Vector3d> residuals;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double scale = 0.0;
  Normal information = Normal::Zero();
};

Eigen::Vector3d middle_of(const std::vector<Pair>& pairs) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Pair& pair : pairs) sum += pair.ours;
  return sum / static_cast<double>(pairs.size());
}

void step(State& state, const Unknowns& by, const Eigen::Vector3d& middle) {
  const Eigen::Matrix3d turn = exp_map(by.head<3>()).toRotationMatrix();
  Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
  move.linear() = turn;
  move.translation() = middle - turn * middle + by.segment<3>(3);
  state.ours_from_reference = move * state.ours_from_reference;
  state.offset += by[kClock];
  state.marker += by.tail<3>();
}

/// One robust Gauss-Newton round; none if too few points are left.
std::optional<Unknowns> improve(const Problem& problem, Solved& solved) {
  solved.pairs = pairs_at(problem, solved.state.offset);
  if (solved.pairs.size() < kLeastSamples) return std::nullopt;
  solved.middle = middle_of(solved.pairs);
  solved.residuals.clear();
  for (const Pair& pair : solved.pairs)
    solved.residuals.push_back(residual(problem, solved.state, pair));
  solved.scale = scale_of(solved.residuals);
  Normal normal = Normal::Zero();
  Unknowns gradient = Unknowns::Zero();
  for (std::size_t i = 0; i < solved.pairs.size(); ++i) {
    const Jacobian j = derivative(problem, solved.state, solved.pairs[i], solved.middle);
    const double weight = robust_weight(solved.residuals[i].norm(), solved.scale);
    normal += weight * j.transpose() * j;
    gradient -= weight * j.transpose() * solved.residuals[i];
  }
  const double prior = std::pow(solved.scale / kOffsetPrior, 2);
  normal.diagonal().tail<3>().array() += prior;
  gradient.tail<3>() -= prior * solved.state.marker;
  const auto free = free_of(problem);
  for (int i = 0; i < kUnknowns; ++i) {
    if (free[i]) continue;
    normal.row(i).setZero();
    normal.col(i).setZero();
    normal(i, i) = 1.0;
    gradient[i] = 0.0;
  }
  solved.information = normal;
  return Unknowns(normal.ldlt().solve(gradient));
}

/// By how many consecutive residuals one is told: their errors last for a while.
double correlated(const std::vector<Eigen::Vector3d>& residuals) {
  constexpr double kNegligible = 0.1;
  double own = 0.0;
  for (const Eigen::Vector3d& each : residuals) own += each.squaredNorm();
  double sum = 1.0;
  for (std::size_t lag = 1; lag < residuals.size() / 4; ++lag) {
    double with = 0.0;
    for (std::size_t i = lag; i < residuals.size(); ++i)
      with += residuals[i].dot(residuals[i - lag]);
    const double share = with / own;
    if (!(share > kNegligible)) break;
    sum += 2.0 * share;
  }
  return sum;
}

/// RMS distance from the middle, on the floor.
double spread_of(const std::vector<Pair>& pairs, const Eigen::Vector3d& middle) {
  double sum = 0.0;
  for (const Pair& pair : pairs)
    sum += (pair.ours - middle).squaredNorm() - std::pow(pair.ours.y() - middle.y(), 2);
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

/// RMS distance from the middle, on the floor, of all points of a trace.
double spread_of(const Trace& trace) {
  std::vector<Pair> pairs;
  for (const TracePoint& point : trace) {
    Pair pair;
    pair.ours = point.place;
    pairs.push_back(pair);
  }
  return pairs.empty() ? 0.0 : spread_of(pairs, middle_of(pairs));
}

Result<Alignment> reported(const Problem& problem, const Solved& solved) {
  std::vector<double> norms;
  for (const Eigen::Vector3d& each : solved.residuals) norms.push_back(each.norm());
  const double middle = median(norms);
  if (middle > kMostMisfit)
    return fail(
        ErrorCode::Conflict, "align",
        fmt::format("the two do not show one motion: half of the points are more than {:.0f} "
                    "mm apart. Another joint (--joint), body (--body) or person? Other axes "
                    "or units (--axes, --unit)? The reference moves {:.2f} times as far",
                    1e3 * middle, spread_of(problem.reference) / spread_of(problem.ours)));
  Alignment out;
  out.ours_from_reference = solved.state.ours_from_reference;
  out.clock_offset = solved.state.offset;
  if (problem.config.marker_offset) out.marker_offset = solved.state.marker;
  out.marker_height = problem.poses;
  out.residuals = solved.residuals;
  for (const Pair& pair : solved.pairs) out.times.push_back(pair.time);
  const Normal covariance =
      solved.information.inverse() * solved.scale * solved.scale * correlated(solved.residuals);
  out.yaw_sigma = std::sqrt(covariance(1, 1));
  out.place_sigma = std::sqrt((covariance(3, 3) + covariance(5, 5)) / 2.0);
  out.clock_sigma = std::sqrt(covariance(kClock, kClock));
  if (!(out.yaw_sigma < kMostYawSigma) || !(out.clock_sigma < kMostClockSigma))
    return fail(ErrorCode::InvalidArgument, "align",
                fmt::format("the walk does not tell {}: walk farther and longer, along straight "
                            "lines in two directions, and not only in a circle",
                            out.clock_sigma < kMostClockSigma ? "the front" : "the clocks apart"));
  return out;
}

}  // namespace

Result<Alignment> align_traces(const Trace& ours, const Trace& reference,
                               const AlignmentConfig& config) {
  const auto offset = rough_offset(ours, reference, config);
  if (!offset) return pass(offset);
  const bool poses =
      std::ranges::all_of(reference, [](const auto& p) { return p.axes.has_value(); });
  const Problem problem{ours, reference, config, config.marker_offset && poses};
  Solved solved;
  solved.state.offset = *offset;
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  for (const Pair& pair : pairs_at(problem, *offset)) {
    from.push_back(pair.reference);
    to.push_back(pair.ours);
  }
  if (const auto fit = fit_yaw(from, to))
    solved.state.ours_from_reference = fit->target_from_source;
  for (int round = 0; round < kRounds; ++round) {
    const auto by = improve(problem, solved);
    if (!by)
      return fail(ErrorCode::NotFound, "align",
                  "fewer than 60 samples of the two are of the same time");
    if (spread_of(solved.pairs, solved.middle) < kLeastSpread)
      return fail(ErrorCode::InvalidArgument, "align",
                  "the person hardly moved: walk through the room for half a minute");
    if (round + 1 < kRounds) step(solved.state, *by, solved.middle);
  }
  return reported(problem, solved);
}

}  // namespace chorus::alignment
