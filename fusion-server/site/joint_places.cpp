#include "fusion-server/site/joint_places.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/square.h"
#include "fusion-server/registration/adjoint.h"

namespace chorus::site {
namespace {

constexpr std::size_t kStates = 4;  // x, z, turn, clock
constexpr Duration kApart = std::chrono::milliseconds(250);
constexpr Duration kLongestHole = std::chrono::milliseconds(200);
constexpr Duration kAside = std::chrono::milliseconds(300);  // for velocities
constexpr double kFewestForVelocity = 6;
constexpr double kErrorTime = 2.0;     // [s] as in registration/offset_profile.cpp
constexpr double kNewEncounter = 1.0;  // [s] after which what is seen is a new encounter
constexpr double kLeastSigma = 0.010;  // [m] two cells never agree better
constexpr double kOutlier = 3.0;
constexpr double kUntied = 100.0;   // [m], [rad]: a cell that nothing ties to the first one
constexpr std::size_t kFewest = 4;  // points
constexpr int kIterations = 20;
constexpr double kStill = 1e-5;

using Matrix24 = Eigen::Matrix<double, 2, 4>;

/// What two cells make of one instant: off = S_a p_a - S_b p_b on the floor, and its derivatives.
struct Term {
  std::size_t a = 0;
  std::size_t b = 0;
  Timestamp at;  ///< By a's clock.
  Eigen::Vector2d off = Eigen::Vector2d::Zero();
  Matrix24 by_a = Matrix24::Zero();
  Matrix24 by_b = Matrix24::Zero();
  double scale = 1.0;  ///< Standard deviation, relative to that of a first instant.
};

const CellPath* path_in(std::span<const CellPath> paths, const CellId& cell) {
  const auto found = std::ranges::find(paths, cell, &CellPath::cell);
  return found == paths.end() ? nullptr : &*found;
}

std::optional<Eigen::Vector3d> place_at(const CellPath& path, Timestamp instant) {
  const auto after = std::ranges::lower_bound(path.at, instant);
  if (after == path.at.begin() || after == path.at.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - path.at.begin());
  const Duration hole = path.at[i] - path.at[i - 1];
  if (hole > kLongestHole || hole <= Duration{0}) return std::nullopt;
  const double share = seconds(instant - path.at[i - 1]) / seconds(hole);
  return path.places[i - 1] + share * (path.places[i] - path.places[i - 1]);
}

/// The slope over all frames around the instant [m/s]: what noise there is in it would tell of
/// clocks what nobody has seen.
std::optional<Eigen::Vector3d> velocity_at(const CellPath& path, Timestamp instant) {
  double count = 0.0;
  double time = 0.0;
  double squares = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d product = Eigen::Vector3d::Zero();
  const auto first = std::ranges::lower_bound(path.at, instant - kAside);
  for (auto at = first; at != path.at.end() && *at <= instant + kAside; ++at) {
    const double t = seconds(*at - instant);
    const Eigen::Vector3d& x = path.places[static_cast<std::size_t>(at - path.at.begin())];
    count += 1.0;
    time += t;
    squares += t * t;
    sum += x;
    product += t * x;
  }
  const double spread = squares - time * time / std::max(1.0, count);
  if (count < kFewestForVelocity || !(spread > 0.0)) return std::nullopt;
  return Eigen::Vector3d((product - time / count * sum) / spread);
}

Eigen::Vector2d on_floor(const Eigen::Vector3d& x) { return {x.x(), x.z()}; }

/// Of a point `x` of the cell, in the site, by the cell's place and turn.
Matrix24 lever(const CellPlace& cell, const Eigen::Vector3d& x) {
  const Eigen::Vector3d arm = x - cell.site_from_cell.translation();
  Matrix24 by = Matrix24::Zero();
  by << 1, 0, arm.z(), 0, 0, 1, -arm.x(), 0;
  return by;
}

std::optional<Term> term_at(const CellPath& mine, const CellPath& theirs,
                            std::span<const CellPlace> cells, Term term) {
  const CellPlace& a = cells[term.a];
  const CellPlace& b = cells[term.b];
  const Timestamp there = term.at + a.clock_added - b.clock_added;
  const auto here = place_at(mine, term.at);
  const auto now = place_at(theirs, there);
  const auto velocity = velocity_at(theirs, there);
  if (!here || !now || !velocity) return std::nullopt;
  const Eigen::Vector3d x_a = a.site_from_cell * *here;
  const Eigen::Vector3d x_b = b.site_from_cell * *now;
  const Eigen::Vector2d moving = on_floor(b.site_from_cell.linear() * *velocity);
  term.off = on_floor(x_a - x_b);
  term.by_a = lever(a, x_a);
  term.by_b = -lever(b, x_b);
  term.by_a.col(3) = -moving;
  term.by_b.col(3) = moving;
  return term;
}

/// What each instant says beyond the one before it.
void whiten(std::vector<Term>& terms) {
  for (std::size_t i = terms.size(); i-- > 1;) {
    const double apart = seconds(terms[i].at - terms[i - 1].at);
    if (apart > kNewEncounter) continue;
    const double kept = std::exp(-apart / kErrorTime);
    terms[i].off -= kept * terms[i - 1].off;
    terms[i].by_a -= kept * terms[i - 1].by_a;
    terms[i].by_b -= kept * terms[i - 1].by_b;
    terms[i].scale = std::sqrt(1.0 - kept * kept);
  }
}

/// Appends what cells a and b saw at once, not whitened.
void add_pair(std::span<const CellPath> paths, std::span<const CellPlace> cells, Term pair,
              std::vector<Term>& terms) {
  const CellPath* mine = path_in(paths, cells[pair.a].cell);
  const CellPath* theirs = path_in(paths, cells[pair.b].cell);
  if (mine == nullptr || theirs == nullptr) return;
  for (const Timestamp at : mine->at) {
    if (pair.at != Timestamp{} && at - pair.at < kApart) continue;
    Term term = pair;
    term.at = at;
    auto made = term_at(*mine, *theirs, cells, term);
    if (!made) continue;
    pair.at = at;
    terms.push_back(std::move(*made));
  }
}

struct Terms {
  std::vector<Term> white;
  double squares = 0.0;  ///< Of all differences as they are [m^2].
};

Terms all_terms(std::span<const CellPath> paths, std::span<const CellPlace> cells) {
  Terms all;
  for (std::size_t a = 0; a < cells.size(); ++a) {
    for (std::size_t b = a + 1; b < cells.size(); ++b) {
      std::vector<Term> terms;
      Term pair;
      pair.a = a;
      pair.b = b;
      add_pair(paths, cells, pair, terms);
      for (const Term& each : terms) all.squares += each.off.squaredNorm();
      whiten(terms);
      all.white.insert(all.white.end(), terms.begin(), terms.end());
    }
  }
  return all;
}

/// The normal equations; `sigma` [m] is the standard deviation of a first instant.
struct Equations {
  Eigen::MatrixXd information;
  Eigen::VectorXd right;
  double squares = 0.0;  ///< Weighted, of the whitened differences, in units of sigma.
  double weight = 0.0;
};

Equations equations_of(const Terms& terms, std::size_t cells, double sigma) {
  const auto size = static_cast<Eigen::Index>(kStates * (cells - 1));
  Equations made{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  const auto index = [](std::size_t cell) {
    return static_cast<Eigen::Index>(kStates * (cell - 1));
  };
  for (const Term& term : terms.white) {
    const double size_of = term.off.norm() / (term.scale * sigma);
    const double trust = size_of > kOutlier ? kOutlier / size_of : 1.0;
    const double weight = trust / square(term.scale * sigma);
    made.squares += trust * square(size_of);
    made.weight += 2.0 * trust;
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

}  // namespace

CellPath path_of(const CellWalk& walk) {
  CellPath path{walk.cell, {}, {}};
  for (const CellPeople& each : walk.seen) {
    if (each.people.size() != 1 || (!path.at.empty() && each.at <= path.at.back())) continue;
    const Person& person = each.people.front();
    if (person.carried && *person.carried > Duration{0}) continue;
    const auto middle = middle_of(person.joints);
    path.at.push_back(each.at);
    path.places.push_back(middle.value_or(person.place));
  }
  return path;
}

std::optional<JointPlaces> joint_places(std::span<const CellPath> paths,
                                        std::vector<CellPlace> cells, double clock_sigma) {
  const std::vector<CellPlace> begin = cells;
  double sigma = 0.05;  // [m] to begin with; the residuals say it
  Equations equations;
  Terms terms;
  for (int i = 0; i < kIterations; ++i) {
    terms = all_terms(paths, cells);
    if (cells.size() < 2 || terms.white.size() < kFewest) return std::nullopt;
    equations = equations_of(terms, cells.size(), sigma);
    sigma = std::max(kLeastSigma, sigma * std::sqrt(equations.squares / equations.weight));
    add_prior(equations, cells, begin, clock_sigma);
    const Eigen::VectorXd step = equations.information.ldlt().solve(equations.right);
    if (!step.allFinite()) return std::nullopt;
    for (std::size_t c = 1; c < cells.size(); ++c)
      move_by(step.segment<kStates>(static_cast<Eigen::Index>(kStates * (c - 1))), cells[c]);
    if (i > 2 && step.norm() < kStill) break;
  }
  enter_covariances(equations, cells);
  const auto points = terms.white.size();
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
