#include "fusion-server/site/joint_terms.h"

#include <algorithm>
#include <cmath>

namespace chorus::site {
namespace {

constexpr Duration kApart = std::chrono::milliseconds(250);
constexpr Duration kLongestHole = std::chrono::milliseconds(200);
constexpr Duration kAside = std::chrono::milliseconds(300);  // for velocities
constexpr double kFewestForVelocity = 6;
constexpr double kErrorTime = 2.0;     // [s] as in registration/offset_profile.cpp
constexpr double kNewEncounter = 1.0;  // [s] after which what is seen is a new encounter

// Of limbs, relative to the middle.  Measured on two real takes, four cameras against four others
// (docs/benchmarks/site.md): errors last 0.35 s, and a limb changes its course several times a
// second.
constexpr Duration kLimbsApart = std::chrono::milliseconds(100);
constexpr Duration kSwingStep = std::chrono::milliseconds(33);
constexpr int kSwingSteps = 3;
constexpr double kLimbErrorTime = 0.35;  // [s]

/// One of the places of a path, by the number of the frame [m]; NaN: not seen.
struct Series {
  const CellPath* path;
  std::size_t limb = kLimbs;  ///< kLimbs: the middle.

  [[nodiscard]] const Eigen::Vector3d& operator()(std::size_t frame) const {
    return limb == kLimbs ? path->places[frame] : path->limbs[frame][limb];
  }
};

std::optional<Eigen::Vector3d> place_at(const Series& series, Timestamp instant) {
  const std::vector<Timestamp>& times = series.path->at;
  const auto after = std::ranges::lower_bound(times, instant);
  if (after == times.begin() || after == times.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - times.begin());
  const Duration hole = times[i] - times[i - 1];
  if (hole > kLongestHole || hole <= Duration{0}) return std::nullopt;
  const double share = seconds(instant - times[i - 1]) / seconds(hole);
  const Eigen::Vector3d place = series(i - 1) + share * (series(i) - series(i - 1));
  return place.allFinite() ? std::optional(place) : std::nullopt;
}

/// The slope over all frames around the instant [m/s]: what noise there is in it would tell of
/// clocks what nobody has seen.
std::optional<Eigen::Vector3d> velocity_at(const Series& series, Timestamp instant) {
  double count = 0.0;
  double time = 0.0;
  double squares = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d product = Eigen::Vector3d::Zero();
  const std::vector<Timestamp>& times = series.path->at;
  const auto first = std::ranges::lower_bound(times, instant - kAside);
  for (auto at = first; at != times.end() && *at <= instant + kAside; ++at) {
    const double t = seconds(*at - instant);
    const Eigen::Vector3d& x = series(static_cast<std::size_t>(at - times.begin()));
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

/// The slope from as much before as after the instant [m/s], all of which must be seen: so the
/// noise in it has nothing in common with that of the place at the instant, which would bias the
/// clock.
std::optional<Eigen::Vector3d> swing_at(const Series& series, Timestamp instant) {
  Eigen::Vector3d product = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (int i = 1; i <= kSwingSteps; ++i) {
    const auto before = place_at(series, instant - i * kSwingStep);
    const auto after = place_at(series, instant + i * kSwingStep);
    if (!before || !after) return std::nullopt;
    product += i * seconds(kSwingStep) * (*after - *before);
    squares += 2.0 * std::pow(i * seconds(kSwingStep), 2);
  }
  return Eigen::Vector3d(product / squares);
}

Eigen::Vector2d on_floor(const Eigen::Vector3d& x) { return {x.x(), x.z()}; }

/// Of a point `x` of the cell, in the site, by the cell's place and turn.
Matrix24 lever(const CellPlace& cell, const Eigen::Vector3d& x) {
  const Eigen::Vector3d arm = x - cell.site_from_cell.translation();
  Matrix24 by = Matrix24::Zero();
  by << 1, 0, arm.z(), 0, 0, 1, -arm.x(), 0;
  return by;
}

/// Two cells, and what each of them saw.
struct Pair {
  std::span<const CellPlace> cells;
  std::size_t a = 0;
  std::size_t b = 0;
  const CellPath* mine = nullptr;
  const CellPath* theirs = nullptr;

  [[nodiscard]] const CellPlace& place_a() const { return cells[a]; }
  [[nodiscard]] const CellPlace& place_b() const { return cells[b]; }
  [[nodiscard]] Timestamp there(Timestamp at) const {
    return at + place_a().clock_added - place_b().clock_added;
  }
};

std::optional<Term> middle_at(const Pair& pair, Timestamp at) {
  const auto here = place_at(*pair.mine, at);
  const auto now = place_at(*pair.theirs, pair.there(at));
  const auto velocity = velocity_at({pair.theirs}, pair.there(at));
  if (!here || !now || !velocity) return std::nullopt;
  const Eigen::Vector3d x_a = pair.place_a().site_from_cell * *here;
  const Eigen::Vector3d x_b = pair.place_b().site_from_cell * *now;
  const Eigen::Vector2d moving = on_floor(pair.place_b().site_from_cell.linear() * *velocity);
  Term term{Term::Of::Middle, pair.a, pair.b, at, on_floor(x_a - x_b)};
  term.by_a = lever(pair.place_a(), x_a);
  term.by_b = -lever(pair.place_b(), x_b);
  term.by_a.col(3) = -moving;
  term.by_b.col(3) = moving;
  return term;
}

/// Limbs tell clocks only: how a cell turns a body is wrong by more than its own turn.
std::optional<Term> limb_at(const Pair& pair, std::size_t limb, Timestamp at) {
  const auto here = place_at(Series{pair.mine, limb}, at);
  const auto now = place_at(Series{pair.theirs, limb}, pair.there(at));
  const auto velocity = swing_at({pair.theirs, limb}, pair.there(at));
  if (!here || !now || !velocity) return std::nullopt;
  const Eigen::Matrix3d& turn_b = pair.place_b().site_from_cell.linear();
  Term term{Term::Of::Limb, pair.a, pair.b, at};
  term.off = on_floor(pair.place_a().site_from_cell.linear() * *here - turn_b * *now);
  term.by_b.col(3) = on_floor(turn_b * *velocity);
  term.by_a.col(3) = -term.by_b.col(3);
  return term;
}

/// Whether the two cells name the sides of the body differently.
bool are_exchanged(const Pair& pair, Timestamp at) {
  double same = 0.0;
  double other = 0.0;
  for (std::size_t left = 0; left < kLimbs; left += 2) {
    const auto l = place_at(Series{pair.mine, left}, at);
    const auto r = place_at(Series{pair.mine, left + 1}, at);
    const auto l_there = place_at(Series{pair.theirs, left}, pair.there(at));
    const auto r_there = place_at(Series{pair.theirs, left + 1}, pair.there(at));
    if (!l || !r || !l_there || !r_there) continue;
    const auto off = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return (pair.place_a().site_from_cell.linear() * a -
              pair.place_b().site_from_cell.linear() * b)
          .squaredNorm();
    };
    same += off(*l, *l_there) + off(*r, *r_there);
    other += off(*l, *r_there) + off(*r, *l_there);
  }
  return other < same;
}

/// What each instant says beyond the one before it.
void whiten(std::vector<Term>& terms, double error_time) {
  for (std::size_t i = terms.size(); i-- > 1;) {
    const double apart = seconds(terms[i].at - terms[i - 1].at);
    if (apart > kNewEncounter) continue;
    const double kept = std::exp(-apart / error_time);
    terms[i].off -= kept * terms[i - 1].off;
    terms[i].by_a -= kept * terms[i - 1].by_a;
    terms[i].by_b -= kept * terms[i - 1].by_b;
    terms[i].scale = std::sqrt(1.0 - kept * kept);
  }
}

void add_white(std::vector<Term> terms, double error_time, Terms& all) {
  whiten(terms, error_time);
  all.white.insert(all.white.end(), terms.begin(), terms.end());
}

/// Appends what the middle of the body says.
void add_middles(const Pair& pair, Terms& all) {
  std::vector<Term> terms;
  for (const Timestamp at : pair.mine->at) {
    if (!terms.empty() && at - terms.back().at < kApart) continue;
    if (auto made = middle_at(pair, at)) terms.push_back(std::move(*made));
  }
  for (const Term& each : terms) all.squares += each.off.squaredNorm();
  all.middles += terms.size();
  add_white(std::move(terms), kErrorTime, all);
}

void add_limbs(const Pair& pair, Terms& all) {
  if (pair.mine->limbs.empty() || pair.theirs->limbs.empty()) return;
  std::array<std::vector<Term>, kLimbs> terms;
  Timestamp last{};
  for (const Timestamp at : pair.mine->at) {
    if (at - last < kLimbsApart || are_exchanged(pair, at)) continue;
    for (std::size_t limb = 0; limb < kLimbs; ++limb) {
      auto made = limb_at(pair, limb, at);
      if (!made) continue;
      terms[limb].push_back(std::move(*made));
      last = at;
    }
  }
  for (std::vector<Term>& each : terms) add_white(std::move(each), kLimbErrorTime, all);
}

}  // namespace

const CellPath* path_in(std::span<const CellPath> paths, const CellId& cell) {
  const auto found = std::ranges::find(paths, cell, &CellPath::cell);
  return found == paths.end() ? nullptr : &*found;
}

std::optional<Eigen::Vector3d> place_at(const CellPath& path, Timestamp instant) {
  return place_at(Series{&path}, instant);
}

Terms all_terms(std::span<const CellPath> paths, std::span<const CellPlace> cells) {
  Terms all;
  for (std::size_t a = 0; a < cells.size(); ++a) {
    for (std::size_t b = a + 1; b < cells.size(); ++b) {
      const Pair pair{cells, a, b, path_in(paths, cells[a].cell), path_in(paths, cells[b].cell)};
      if (pair.mine == nullptr || pair.theirs == nullptr) continue;
      add_middles(pair, all);
      add_limbs(pair, all);
    }
  }
  return all;
}

}  // namespace chorus::site
