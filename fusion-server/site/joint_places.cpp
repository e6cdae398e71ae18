#include "fusion-server/site/joint_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "common/base/square.h"
#include "fusion-server/registration/adjoint.h"
#include "fusion-server/site/joint_terms.h"

namespace chorus::site {
namespace {

constexpr double kLeastSigma = 0.010;  // [m] two cells never agree better
constexpr double kFirstSigma = 0.05;   // [m] to begin with; the residuals say it
constexpr double kOutlier = 3.0;
constexpr double kUntied = 100.0;   // [m], [rad]: a cell that nothing ties to the first one
constexpr std::size_t kFewest = 4;  // points
constexpr int kIterations = 20;
constexpr double kStill = 1e-5;

constexpr std::size_t kKinds = 2;
std::size_t kind(const Term& term) { return static_cast<std::size_t>(term.of); }

/// The standard deviation of a first instant, for each kind of term [m].
using Sigmas = std::array<double, kKinds>;

/// The normal equations.
struct Equations {
  Eigen::MatrixXd information;
  Eigen::VectorXd right;
  /// By kind: weighted, of the whitened differences, in units of sigma.
  std::array<double, kKinds> squares{};
  std::array<double, kKinds> weight{};
};

Equations equations_of(const Terms& terms, std::size_t cells, const Sigmas& sigmas) {
  const auto size = static_cast<Eigen::Index>(kStates * (cells - 1));
  Equations made{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  const auto index = [](std::size_t cell) {
    return static_cast<Eigen::Index>(kStates * (cell - 1));
  };
  for (const Term& term : terms.white) {
    const double sigma = term.scale * sigmas[kind(term)];
    const double size_of = term.off.norm() / sigma;
    const double trust = size_of > kOutlier ? kOutlier / size_of : 1.0;
    const double weight = trust / square(sigma);
    made.squares[kind(term)] += trust * square(size_of);
    made.weight[kind(term)] += 2.0 * trust;
    const auto add = [&](std::size_t one, const Matrix24& by_one) {
      if (one == 0) return;
      made.right.segment<kStates>(index(one)) -= weight * by_one.transpose() * term.off;
      for (const auto& [other, by_other] :
           {std::pair(term.a, term.by_a), std::pair(term.b, term.by_b)})
        if (other != 0)
          made.information.block<kStates, kStates>(index(one), index(other)) +=
              weight * by_one.transpose() * by_other;
    };
    add(term.a, term.by_a);
    add(term.b, term.by_b);
  }
  return made;
}

/// What the residuals say of the standard deviations.
void learn(const Equations& equations, Sigmas& sigmas) {
  for (std::size_t i = 0; i < kKinds; ++i) {
    if (equations.weight[i] <= 0.0) continue;
    sigmas[i] =
        std::max(kLeastSigma, sigmas[i] * std::sqrt(equations.squares[i] / equations.weight[i]));
  }
}

void move_by(const Eigen::Vector4d& step, CellPlace& cell) {
  cell.site_from_cell.translation() += Eigen::Vector3d(step[0], 0, step[1]);
  cell.site_from_cell.linear() =
      Eigen::AngleAxisd(step[2], Eigen::Vector3d::UnitY()) * cell.site_from_cell.linear();
  cell.clock_added += from_seconds(step[3]);
}

/// Enters what is known of x, z and the turn; tilt and height are left as they are.
void state_covariance(const Eigen::Matrix4d& known, CellPlace& cell) {
  constexpr std::array<Eigen::Index, 3> kAxes{3, 5, 1};
  for (const Eigen::Index axis : kAxes) {
    cell.covariance.row(axis).setZero();
    cell.covariance.col(axis).setZero();
  }
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    for (std::size_t j = 0; j < kAxes.size(); ++j)
      cell.covariance(kAxes[i], kAxes[j]) =
          known(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  cell.clock_sigma = std::max<Duration>(from_seconds(std::sqrt(std::max(0.0, known(3, 3)))),
                                        std::chrono::milliseconds(1));
}

/// What is known before anybody walked; clocks are pulled towards where they began.
void add_prior(Equations& equations, std::span<const CellPlace> cells,
               std::span<const CellPlace> begin, double clock_sigma) {
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(kStates * (i - 1));
    for (Eigen::Index k = 0; k < 3; ++k)
      equations.information(at + k, at + k) += 1.0 / square(kUntied);
    equations.information(at + 3, at + 3) += 1.0 / square(clock_sigma);
    equations.right[at + 3] +=
        seconds(begin[i].clock_added - cells[i].clock_added) / square(clock_sigma);
  }
}

/// Of every cell but the first.
void enter_covariances(const Equations& equations, std::vector<CellPlace>& cells) {
  const auto size = equations.information.rows();
  const Eigen::MatrixXd known =
      equations.information.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  for (std::size_t c = 1; c < cells.size(); ++c) {
    const auto at = static_cast<Eigen::Index>(kStates * (c - 1));
    state_covariance(known.block<kStates, kStates>(at, at), cells[c]);
  }
}

Limbs limbs_of(const Located& joints, const Eigen::Vector3d& middle) {
  using enum JointId;
  constexpr std::array<JointId, kLimbs> kLimbJoints{ElbowLeft, ElbowRight, WristLeft, WristRight,
                                                    KneeLeft,  KneeRight,  AnkleLeft, AnkleRight};
  Limbs limbs;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const auto& joint = joints[index_of(kLimbJoints[i])];
    limbs[i] = joint ? Eigen::Vector3d(*joint - middle)
                     : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  return limbs;
}

}  // namespace

CellPath path_of(const CellWalk& walk) {
  CellPath path{walk.cell, {}, {}, {}};
  for (const CellPeople& each : walk.seen) {
    if (each.people.size() != 1 || (!path.at.empty() && each.at <= path.at.back())) continue;
    const Person& person = each.people.front();
    if (person.carried && *person.carried > Duration{0}) continue;
    const auto middle = middle_of(person.joints);
    path.at.push_back(each.at);
    path.places.push_back(middle.value_or(person.place));
    path.limbs.push_back(limbs_of(person.joints, path.places.back()));
  }
  return path;
}

std::optional<JointPlaces> joint_places(std::span<const CellPath> paths,
                                        std::vector<CellPlace> cells, double clock_sigma) {
  const std::vector<CellPlace> begin = cells;
  Sigmas sigmas{kFirstSigma, kFirstSigma};
  Equations equations;
  Terms terms;
  for (int i = 0; i < kIterations; ++i) {
    terms = all_terms(paths, cells);
    if (cells.size() < 2 || terms.middles < kFewest) return std::nullopt;
    equations = equations_of(terms, cells.size(), sigmas);
    learn(equations, sigmas);
    add_prior(equations, cells, begin, clock_sigma);
    const Eigen::VectorXd step = equations.information.ldlt().solve(equations.right);
    if (!step.allFinite()) return std::nullopt;
    for (std::size_t c = 1; c < cells.size(); ++c)
      move_by(step.segment<kStates>(static_cast<Eigen::Index>(kStates * (c - 1))), cells[c]);
    if (i > 2 && step.norm() < kStill) break;
  }
  enter_covariances(equations, cells);
  const auto points = terms.middles;
  return JointPlaces{std::move(cells), std::sqrt(terms.squares / static_cast<double>(points)),
                     points};
}

std::vector<PairwiseRegistration> pairs_of(std::span<const CellPath> paths,
                                           const JointPlaces& all) {
  std::vector<PairwiseRegistration> pairs;
  for (std::size_t a = 0; a < all.cells.size(); ++a) {
    for (std::size_t b = a + 1; b < all.cells.size(); ++b) {
      const CellPlace& one = all.cells[a];
      CellPlace other = all.cells[b];
      const double clock = std::hypot(seconds(one.clock_sigma), seconds(other.clock_sigma));
      const auto found = joint_places(paths, {one, other}, clock);
      if (!found) continue;
      PairwiseRegistration pair;
      pair.target = one.cell;
      pair.source = other.cell;
      pair.target_from_source = one.site_from_cell.inverse() * found->cells[1].site_from_cell;
      pair.rms = found->rms;
      pair.pairs = found->points;
      // About the site's axes at the source's origin; about the target's, at its own.
      const Eigen::Matrix3d turn = one.site_from_cell.linear().transpose();
      registration::Matrix6 turned = registration::Matrix6::Zero();
      turned.topLeftCorner<3, 3>() = turned.bottomRightCorner<3, 3>() = turn;
      const registration::Matrix6 move =
          registration::at_point(-pair.target_from_source.translation()) * turned;
      pair.covariance = move * found->cells[1].covariance * move.transpose();
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

}  // namespace chorus::site
